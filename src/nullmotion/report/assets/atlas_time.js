// Time, shared with the charts of a run.
const clock = $("#atlas-time");
const span = () => {
  const times = array(state.motion.t);
  return [times[0], times.at(-1)];
};
const whole = () => data.motions.reduce(([from, to], motion) => {
  const times = array(motion.t);
  return [Math.min(from, times[0]), Math.max(to, times.at(-1))];
}, [Infinity, -Infinity]);

function goTo(time, tell = true) {
  const [from, to] = whole();
  state.time = clamp(time, from, to);
  state.byHand = false;
  state.marked = null;
  clock.value = String(Math.round((1000 * (state.time - from)) / (to - from || 1)));
  const text = `${tidy(state.time)} s`;
  $("#atlas-clock").textContent = text;
  clock.setAttribute("aria-valuetext", text);
  show();
  if (tell) document.dispatchEvent(new CustomEvent("atlas-time", { detail: state.time }));
}

if (state.motion) {
  clock.addEventListener("input", () => {
    const [from, to] = whole();
    pause();
    goTo(from + (Number(clock.value) / 1000) * (to - from));
  });
  document.addEventListener("chart-time", (event) => goTo(event.detail, false));
  $("#atlas-play").addEventListener("click", () => (playing ? pause() : play()));
  $("#atlas-motion")?.addEventListener("change", (event) => {
    state.motion = data.motions[Number(event.target.value)];
    goTo(state.time);
  });
}

let playing = 0;
function play() {
  const [from, to] = span();
  const begin = state.time >= to - 1e-9 || state.time < from ? from : state.time;
  const pace = Math.max((to - from) / 12, 1e-9); // a run takes twelve seconds
  const started = performance.now();
  $("#atlas-play").textContent = "Pause";
  const step = (now) => {
    const time = begin + (pace * Math.max(0, now - started)) / 1000;
    goTo(Math.min(time, to));
    if (time < to) playing = requestAnimationFrame(step); else pause();
  };
  playing = requestAnimationFrame(step);
}
function pause() {
  cancelAnimationFrame(playing);
  playing = 0;
  $("#atlas-play").textContent = "Play";
}
