"use strict";
(() => {
  const { arrays, figures } = JSON.parse(document.getElementById("charts").textContent);
  // The names of instants stand above the charts.
  const named = Object.values(figures).some((f) => f.layout.annotations.some((a) => a.yref === "paper"));
  const BASE = {
    margin: { l: 70, r: 12, t: named ? 24 : 8, b: 44 },
    font: { family: "system-ui, -apple-system, Segoe UI, Roboto, Arial, sans-serif", size: 12, color: "#1b1f24" },
    paper_bgcolor: "#fff", plot_bgcolor: "#fff",
    showlegend: false, hovermode: false,
    dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
  };
  const CONFIG = { displayModeBar: false, responsive: true, displaylogo: false, doubleClick: false };
  const DASHES = { solid: "", dash: "9 4", dot: "2 3", dashdot: "9 3 2 3", longdash: "16 4" };
  const LEFT = BASE.margin.l, RIGHT = BASE.margin.r, TOP = BASE.margin.t, BOTTOM = BASE.margin.b;

  // ---- data: base64 to typed arrays, each decoded once ----
  const decoded = new Map();
  function array(index) {
    if (!decoded.has(index)) {
      const [kind, coded] = arrays[index].split(":");
      const bytes = Uint8Array.from(atob(coded), (c) => c.charCodeAt(0));
      decoded.set(index, kind === "f8" ? new Float64Array(bytes.buffer) : new Float32Array(bytes.buffer));
    }
    return decoded.get(index);
  }

  const escaped = (s) => s.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
  const traces = (figure) => figure.traces.map((trace) => ({
    ...trace, type: "scatter", hoverinfo: "skip", connectgaps: false,
    name: escaped(trace.name), x: array(trace.x), y: array(trace.y), marker: { size: 5 },
  }));

  const charts = [...document.querySelectorAll("[data-chart]")].map((box) => {
    const figure = figures[box.dataset.chart];
    const cursor = document.createElement("div");
    cursor.className = "cursor";
    cursor.hidden = true;
    return { box, figure, key: box.dataset.chart, cursor, readouts: [] };
  });
  const byKey = new Map(charts.map((chart) => [chart.key, chart]));
  const group = (chart) => (chart.figure.group ? charts.filter((c) => c.figure.group === chart.figure.group) : [chart]);

  // ---- legends: real buttons that switch curves and show values at the cursor ----
  function sample(line) {
    const dash = DASHES[line.dash] ?? "";
    const span = document.createElement("span");
    span.innerHTML = `<svg width="30" height="10" aria-hidden="true"><line x1="0" y1="5" x2="30" y2="5"
      stroke="${line.color}" stroke-width="${Math.max(2, line.width)}" stroke-dasharray="${dash}"/></svg>`;
    return span.firstChild;
  }

  // Pointing at an entry brings its curve out among the others.
  function highlight(button, where) {
    const show = (on) => where.forEach(([chart, i]) => {
      const opacity = chart.figure.traces.map((_, j) => (on && j !== i ? 0.15 : 1));
      Plotly.restyle(chart.box, { opacity });
    });
    button.addEventListener("mouseenter", () => show(true));
    button.addEventListener("mouseleave", () => show(false));
  }

  function entry(trace, where) {
    const button = document.createElement("button");
    const name = document.createElement("span");
    const value = document.createElement("span");
    button.type = "button";
    button.setAttribute("aria-pressed", "true");
    name.textContent = trace.name;
    value.className = "value";
    button.append(sample(trace.line), name, value);
    button.addEventListener("click", () => {
      const visible = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(visible));
      where.forEach(([chart, i]) => Plotly.restyle(chart.box, { visible }, [i]));
    });
    if (matchMedia("(hover: hover)").matches) highlight(button, where);
    return { button, value };
  }

  function ownLegend(place) {
    const chart = byKey.get(place.dataset.legend);
    chart.figure.traces.forEach((trace, i) => {
      const { button, value } = entry(trace, [[chart, i]]);
      chart.readouts.push({ trace, value });
      place.append(button);
    });
  }

  // Its values are those of the chart that was pointed at last.
  const legends = [];
  function commonLegend(place) {
    const names = new Map();
    for (const chart of charts.filter((c) => c.figure.legend === place.dataset.commonLegend))
      chart.figure.traces.forEach((trace, i) => {
        if (!names.has(trace.name)) names.set(trace.name, { trace, where: [] });
        names.get(trace.name).where.push([chart, i]);
      });
    const of = document.createElement("span");
    of.className = "of";
    place.append(of);
    const entries = [...names.values()].map(({ trace, where }) => {
      const { button, value } = entry(trace, where);
      place.append(button);
      return { where: new Map(where), value };
    });
    legends.push({ name: place.dataset.commonLegend, of, entries });
  }

  // ---- one cursor for all charts of a group ----
  const range = (chart) => chart.box.layout.xaxis.range.map(Number);
  const width = (chart) => chart.box.clientWidth - LEFT - RIGHT;

  function nearest(x, t) {
    let low = 0, high = x.length - 1;
    if (high < 0 || t < x[0] || t > x[high]) return -1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (x[middle] <= t) low = middle; else high = middle;
    }
    return t - x[low] <= x[high] - t ? low : high;
  }

  const tidy = (v) => {
    if (!Number.isFinite(v)) return "–";
    const size = Math.abs(v);
    const written = size !== 0 && (size < 1e-3 || size >= 1e5) ? v.toExponential(2) : String(+v.toPrecision(4));
    return written.replaceAll("-", "−");
  };

  // Rates act from their row on, so the last row has none: there the one before still holds.
  function reading(x, y, t, size) {
    let i = nearest(x, t);
    if (i < 0) return "–";
    if (i === y.length - 1 && i > 0 && !Number.isFinite(y[i])) i -= 1;
    return tidy(Math.abs(y[i]) < 1e-6 * size ? 0 : y[i]);
  }

  // Where small values are noise; on a logarithmic axis they are not.
  function scale(chart) {
    if (chart.figure.layout.yaxis.type === "log") return 0;
    chart.scale ??= chart.figure.traces.reduce((most, trace) =>
      array(trace.y).reduce((m, v) => (Number.isFinite(v) ? Math.max(m, Math.abs(v)) : m), most), 0);
    return chart.scale;
  }

  function place(chart, t) {
    const [from, to] = range(chart);
    const at = (t - from) / (to - from);
    chart.cursor.hidden = !(at >= 0 && at <= 1);
    chart.cursor.style.left = `${LEFT + at * width(chart)}px`;
    for (const { trace, value } of chart.readouts) {
      value.textContent = reading(array(trace.x), array(trace.y), t, scale(chart));
    }
  }

  function placeCommon(chart, t) {
    for (const { of, entries } of legends.filter((l) => l.name === chart.figure.legend)) {
      of.textContent = `Values: ${chart.figure.title}, ${chart.box.layout.yaxis.title.text}`;
      for (const { where, value } of entries) {
        const trace = chart.figure.traces[where.get(chart)];
        value.textContent = trace ? reading(array(trace.x), array(trace.y), t, scale(chart)) : "";
      }
    }
  }

  const slider = document.getElementById("cursor");
  const clock = document.getElementById("cursor-time");
  let wanted = null;
  function moveCursor(chart, t, quiet = false) {
    const idle = wanted === null;
    wanted = [chart, t, quiet];
    if (!idle) return;
    requestAnimationFrame(() => {
      const [where, time, heard] = wanted;
      wanted = null;
      for (const c of group(where)) place(c, time);
      placeCommon(where, time);
      if (slider && where.figure.group) {
        const [from, to] = whole(where);
        slider.value = String(Math.round((1000 * (time - from)) / (to - from)));
        clock.textContent = `${tidy(time)} s`;
        slider.setAttribute("aria-valuetext", clock.textContent);
      }
      // The array in momentum space turns along; it does not hear what it said itself.
      if (!heard && where.figure.group === "time") document.dispatchEvent(new CustomEvent("chart-time", { detail: time }));
    });
  }

  function whole(chart) {
    let from = Infinity, to = -Infinity;
    for (const c of group(chart))
      for (const trace of c.figure.traces) {
        const x = array(trace.x);
        if (x.length) { from = Math.min(from, x[0]); to = Math.max(to, x[x.length - 1]); }
      }
    if (!(to > from)) [from, to] = Number.isFinite(from) ? [from - 0.5, from + 0.5] : [0, 1];
    return [from, to];
  }

  function follow(chart) {
    const point = (event) => {
      const px = event.clientX - chart.box.getBoundingClientRect().left - LEFT;
      const [from, to] = range(chart);
      const t = from + (px / width(chart)) * (to - from);
      if (t >= Math.min(from, to) && t <= Math.max(from, to)) moveCursor(chart, t);
    };
    chart.box.addEventListener("pointermove", point);
    chart.box.addEventListener("pointerdown", point);
    chart.box.addEventListener("dblclick", () => reset(chart));
  }

  // ---- zoom: shared along time, own along the ordinate ----
  let zooming = false;
  async function zoomed(chart, change) {
    if (zooming || !("xaxis.range[0]" in change)) return;
    zooming = true;
    const next = [change["xaxis.range[0]"], change["xaxis.range[1]"]];
    await Promise.all(group(chart).filter((c) => c !== chart).map((c) => Plotly.relayout(c.box, { "xaxis.range": next })));
    zooming = false;
  }

  async function reset(chart) {
    zooming = true;
    const range = whole(chart);
    await Promise.all(group(chart).map((c) => Plotly.relayout(c.box, { "xaxis.range": [...range], "yaxis.autorange": true })));
    zooming = false;
  }

  // ---- pictures to take away: with title and legend in them ----
  function save(chart) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "save";
    button.textContent = "Save PNG";
    button.setAttribute("aria-label", `Save chart as PNG: ${chart.figure.title}`);
    button.addEventListener("click", () => Plotly.downloadImage(
      { data: chart.box.data, layout: { ...chart.box.layout, showlegend: true, title: { text: escaped(chart.figure.title) }, margin: { l: 70, r: 20, t: 50, b: 50 } } },
      { format: "png", width: 900, height: 520, scale: 2, filename: `nullmotion-${chart.key}` }));
    chart.box.closest("figure").append(button);
  }

  function draw(chart) {
    const layout = {
      ...BASE, ...chart.figure.layout,
      xaxis: { ...chart.figure.layout.xaxis, range: whole(chart) },
    };
    if (chart.box.clientHeight < 230) layout.yaxis = { ...layout.yaxis, nticks: 5 };
    Plotly.newPlot(chart.box, traces(chart.figure), layout, CONFIG);
    chart.cursor.style.top = `${TOP}px`;
    chart.cursor.style.bottom = `${BOTTOM}px`;
    chart.box.append(chart.cursor);
    chart.box.on("plotly_relayout", (change) => zoomed(chart, change));
    follow(chart);
    save(chart);
  }

  charts.forEach(draw);
  document.querySelectorAll("[data-legend]").forEach(ownLegend);
  document.querySelectorAll("[data-common-legend]").forEach(commonLegend);

  const linked = charts.find((chart) => chart.figure.group);
  if (linked) document.getElementById("reset")?.addEventListener("click", () => reset(linked));
  if (slider && linked) {
    slider.addEventListener("input", () => {
      const [from, to] = whole(linked);
      moveCursor(linked, from + (Number(slider.value) / 1000) * (to - from));
    });
    moveCursor(linked, whole(linked)[1]);
    document.addEventListener("atlas-time", (event) => moveCursor(linked, event.detail, true));
  }

  // On paper a page is 700 px wide, whatever the window is.
  const resized = (size) => charts.forEach((chart) => Plotly.relayout(chart.box, size(chart)));
  addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach((d) => { d.open = true; });
    charts.forEach((chart) => { chart.cursor.hidden = true; });
    resized((chart) => (chart.box.closest("figure.small") ? { width: 225, height: 170 } : { width: 340, height: 230 }));
  });
  addEventListener("afterprint", () => resized(() => ({ autosize: true, width: null, height: null })));
})();
