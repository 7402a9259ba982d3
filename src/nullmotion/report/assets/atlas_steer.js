// Turning and zooming: pointer, keys, buttons.
const steer = {
  left: () => look.turn(-0.12, 0),
  right: () => look.turn(0.12, 0),
  up: () => look.turn(0, 0.1),
  down: () => look.turn(0, -0.1),
  closer: (which) => look.scale(1.15, which),
  farther: (which) => look.scale(1 / 1.15, which),
  reset: () => look.reset(),
};
const KEYS = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down", "+": "closer", "=": "closer", "-": "farther", Home: "reset" };
const turned = () => (space ? space.moved() : repaint(...[...painters].filter((p) => !p.flat)));

all("[data-steer]").forEach((button) => button.addEventListener("click", () => { steer[button.dataset.steer](planar ? "array" : "space"); turned(); }));
all(".view3d").forEach((view) => {
  const which = view.id === "atlas-space" ? "space" : "array";
  view.addEventListener("keydown", (event) => {
    const act = KEYS[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    steer[act](which);
    turned();
  });
  const fingers = new Map();
  let gone = 0, apart = 0;
  view.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    view.setPointerCapture(event.pointerId);
    gone = 0;
    apart = 0;
  });
  view.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    gone += Math.abs(dx) + Math.abs(dy);
    if (fingers.size === 2) {
      const [[ax, ay], [bx, by]] = [...fingers.values()];
      const now = Math.hypot(ax - bx, ay - by);
      if (apart) look.scale(now / apart, which);
      apart = now;
    }
    look.turn((dx / view.clientWidth) * 4 / fingers.size, (dy / view.clientHeight) * 3 / fingers.size);
    turned();
  });
  const lifted = (event) => {
    const clicked = fingers.delete(event.pointerId) && event.type === "pointerup" && gone < 4;
    if (!clicked || !space || view.id !== "atlas-space") return;
    const box = view.getBoundingClientRect();
    const hit = space.pick(event.clientX - box.left, event.clientY - box.top);
    if (hit) meet(hit);
  };
  view.addEventListener("pointerup", lifted);
  view.addEventListener("pointercancel", lifted);
  view.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== view) return; // the page scrolls
    event.preventDefault();
    look.scale(Math.exp(-event.deltaY * 0.002), which);
    turned();
  }, { passive: false });
});
