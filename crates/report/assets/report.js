// Draws the plots of a report page from the JSON in it: one uPlot per figure, cursor and zoom shared within a group.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("plot-data").textContent);
  const columns = page.columns.map(column => Array.isArray(column) ? column
    : Array.from({ length: column.count }, (_, line) => column.from + line * column.step));
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const GUTTER = 52;
  const drawn = [];

  let palette = {};
  function readPalette() {
    const style = getComputedStyle(root);
    palette = new Proxy({}, { get: (known, name) => known[name] ??= style.getPropertyValue("--" + name).trim() });
  }
  readPalette();

  const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const minus = text => text.replace("-", "−");
  const raised = exponent => (exponent < 0 ? "⁻" : "") + [...String(Math.abs(exponent))].map(digit => SUPERSCRIPT[digit]).join("");

  // Read-out of a value: five significant digits, a power of ten where zeros would fill the line.
  function number(value) {
    if (value == null || !isFinite(value)) return "–";
    if (value === 0) return "0";
    const exponent = Math.floor(Math.log10(Math.abs(value)));
    if (exponent >= -4 && exponent < 7) return minus(value.toFixed(Math.max(0, Math.min(12, 4 - exponent))));
    const [mantissa, power] = value.toExponential(3).split("e");
    return minus(mantissa) + "×10" + raised(Number(power));
  }
  const withUnit = (text, unit) => unit && text !== "–" ? text + " " + unit : text;

  function linearTicks(u, splits, axis, space, step) {
    const largest = Math.max(...splits.map(Math.abs));
    if (largest >= 1e6 || (largest > 0 && largest < 1e-3)) {
      const power = Math.floor(Math.log10(largest)), digits = Math.max(0, power - Math.floor(Math.log10(step) + 1e-9));
      return splits.map(v => v === 0 ? "0" : minus((v / 10 ** power).toFixed(digits)) + "×10" + raised(power));
    }
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const fits = splits.every(v => Math.abs(v - Number(v.toFixed(decimals))) < step * 1e-3);
    return splits.map(v => minus((v + 0).toFixed(fits ? decimals : decimals + 1)));
  }
  function logTicks(u, splits) {
    const shown = splits.filter(v => v != null);
    const plain = shown.every(v => v >= 1e-3 && v < 1e5);
    return splits.map(v => {
      if (v == null) return "";
      if (plain) return String(Number(v.toPrecision(6)));
      const power = Math.round(Math.log10(v)), leading = v / 10 ** power;
      return Math.abs(leading - 1) < 1e-6 ? "10" + raised(power) : "";
    });
  }

  // Over many decades only these get a grid line.
  const decades = (u, splits) => splits.length <= 30 ? splits
    : splits.map(v => v != null && Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-6 ? v : null);

  // The percentile rule of the first view, applied to the lines in view after a zoom.
  function robustExtent(values, [low, high], log) {
    values.sort((a, b) => a - b);
    const at = percent => values[Math.round((values.length - 1) * percent / 100)];
    const a = at(low), b = at(high);
    const ends = log ? [a * a / b, b * b / a] : [2 * a - b, 2 * b - a];
    return [Math.max(ends[0], values[0]), Math.min(ends[1], values[values.length - 1])];
  }
  function padded([low, high], spacing) {
    if (spacing === "logarithmic") { const air = Math.max(1.05, (high / low) ** 0.04); return [low / air, high * air]; }
    const air = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? 0.05 * (high - low) : 0.1 * Math.abs(high) || 1;
    return [low - air, high + air];
  }

  // uPlot counts logarithmic ticks up from the low end; where its first step leaps over the next decade it never comes to an end.
  function startable([low, high], spacing) {
    const decade = 10 ** Math.floor(Math.log10(low));
    return [spacing === "logarithmic" && low > 9.4 * decade ? 9 * decade : low, high];
  }

  class Pane {
    constructor(figure, plot) {
      this.figure = figure;
      this.plot = plot;
      this.box = figure.querySelector(".drawing");
      this.at = figure.querySelector(".at");
      this.fullRange = !plot.first;
      this.hiddenMarks = new Set();
      this.collect();
      this.u = new uPlot(this.options(), this.data, this.box);
      this.connect();
    }

    // Tables over different lines are joined: a missing line is undefined and drawn across, a masked one is null and a gap.
    collect() {
      const used = this.plot.tables.map(table => table.map(index => columns[index]));
      const filled = used.filter(table => table.length);
      this.data = filled.length > 1 ? uPlot.join(filled) : filled[0] || [[]];
      this.offset = [];
      let next = 1;
      for (const table of used) { this.offset.push(next - 1); next += Math.max(0, table.length - 1); }
      this.indices = this.plot.series.map(series => series.places.map(place => this.offset[series.table] + place));
      const x = this.data[0];
      this.extent = x.length ? [x[0], x[x.length - 1]] : [0, 1];
      // Points at the ends are drawn whole.
      if (this.plot.x.spacing !== "logarithmic" && this.plot.series.some(s => s.style === "points")) {
        const air = 0.03 * (this.extent[1] - this.extent[0]) || 0.5;
        this.extent = [this.extent[0] - air, this.extent[1] + air];
      }
      if (!x.length) for (const mark of this.plot.marks) if (mark.shaded) this.extent = [mark.shaded.from, mark.shaded.to];
    }

    options() {
      const { plot } = this, series = [{}], bands = [];
      plot.series.forEach((s, key) => this.indices[key].forEach(index => { series[index] = this.series(s); }));
      plot.series.forEach((s, key) => {
        if (s.style === "band") bands.push({ series: [this.indices[key][1], this.indices[key][0]], fill: () => palette[s.colour] + "42" });
      });
      const axis = (spacing, extra) => ({
        stroke: () => palette.soft, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 18, labelGap: 2, gap: 4,
        grid: { stroke: () => palette.grid, width: 1, ...spacing }, ticks: { stroke: () => palette.rule, width: 1, size: 5, ...spacing }, ...extra,
      });
      const title = a => a.unit ? `${a.label} (${a.unit})` : a.label;
      const log = a => a.spacing === "logarithmic";
      return {
        ...this.size(), series, bands, legend: { show: false }, padding: [8, 14, 0, 0],
        scales: {
          x: { time: false, distr: log(plot.x) ? 3 : 1, range: (u, low, high) => startable(low == null || low <= this.data[0][0] && high >= this.data[0][this.data[0].length - 1] ? this.extent : low < high ? [low, high] : [low - 0.5, low + 0.5], plot.x.spacing) },
          y: { distr: log(plot.y) ? 3 : 1, range: (u, low, high) => startable(this.ordinates(u, low, high), plot.y.spacing) },
        },
        axes: [
          axis(log(plot.x) ? { filter: decades } : {}, { label: title(plot.x), size: 26, values: log(plot.x) ? logTicks : linearTicks, space: 60 }),
          axis(log(plot.y) ? { filter: decades } : {}, { label: title(plot.y), values: log(plot.y) ? logTicks : linearTicks, space: 28,
            size: (u, values) => Math.max(GUTTER, 14 + 7 * Math.max(0, ...(values || []).map(v => v.length))) }),
        ],
        cursor: {
          drag: { x: true, y: false, dist: 4 }, points: { size: 6, fill: (u, i) => series[i].show === false ? "transparent" : palette[series[i].colour], width: 0 },
          sync: plot.group == null ? undefined : { key: plot.group, setSeries: false, scales: ["x", null],
            filters: { pub: type => type === "mousemove" || type === "mouseleave", sub: type => type === "mousemove" || type === "mouseleave" } },
        },
        hooks: { drawClear: [u => this.ground(u)], draw: [u => this.lines(u)], setCursor: [u => this.readOut(u)], setScale: [(u, key) => key === "x" && this.share(u)] },
      };
    }

    series(s) {
      const stroke = () => palette[s.colour];
      const common = { colour: s.colour, scale: "y", stroke, width: 1.4, points: { show: true, size: 3, stroke, fill: stroke, filter: (u, index) => this.isolated(index) } };
      if (s.style === "dashed") return { ...common, dash: [6, 4] };
      if (s.style === "points") return { ...common, paths: () => null, points: { show: true, size: 5, stroke, fill: stroke, width: 0 } };
      if (s.style === "band") return { ...common, width: 0, stroke: "transparent", points: { show: false } };
      return common;
    }

    // A line between two gaps has no neighbour to be joined to: it is drawn as a point.
    isolated(index) {
      const values = this.data[index], found = [];
      const gap = line => line < 0 || line >= values.length || values[line] === null;
      for (let line = 0; line < values.length; line++) if (values[line] != null && gap(line - 1) && gap(line + 1)) found.push(line);
      return found;
    }

    ordinates(u, low, high) {
      const { plot } = this, [from, to] = [u.scales.x.min ?? this.extent[0], u.scales.x.max ?? this.extent[1]];
      const zoomed = from > this.extent[0] || to < this.extent[1];
      if (!this.fullRange && (!zoomed || !plot.percentiles)) return plot.first;
      const log = plot.y.spacing === "logarithmic";
      let extent = low == null ? null : [low, high];
      if (!this.fullRange) extent = this.robust(from, to, log) || extent;
      for (const mark of plot.marks) if (mark.horizontal && (!log || mark.horizontal.at > 0)) {
        const at = mark.horizontal.at;
        extent = extent ? [Math.min(extent[0], at), Math.max(extent[1], at)] : [at, at];
      }
      return extent ? padded(extent, plot.y.spacing) : log ? [1, 10] : [-1, 1];
    }

    robust(from, to, log) {
      const x = this.data[0];
      let extent = null;
      this.plot.series.forEach((s, key) => {
        if (s.style === "band") return;
        const values = this.data[this.indices[key][0]].filter((v, line) => v != null && x[line] >= from && x[line] <= to);
        if (!values.length) return;
        const [a, b] = robustExtent(values, this.plot.percentiles, log);
        extent = extent ? [Math.min(extent[0], a), Math.max(extent[1], b)] : [a, b];
      });
      return extent;
    }

    clipped(u, draw) {
      const { ctx, bbox } = u;
      ctx.save();
      ctx.beginPath();
      ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
      ctx.clip();
      draw(ctx, bbox);
      ctx.restore();
    }

    ground(u) {
      this.clipped(u, (ctx, bbox) => this.plot.marks.forEach((mark, key) => {
        if (mark.horizontal || this.hiddenMarks.has(key)) return;
        if (mark.vertical) {
          // Below the curves: a peak stands exactly where the line does.
          const x = u.valToPos(mark.vertical.at, "x", true);
          ctx.beginPath();
          ctx.moveTo(x, bbox.top); ctx.lineTo(x, bbox.top + bbox.height);
          this.dashed(ctx, mark.vertical.colour);
          return;
        }
        const a = u.valToPos(mark.shaded.from, "x", true), b = u.valToPos(mark.shaded.to, "x", true);
        ctx.fillStyle = palette.shade;
        ctx.fillRect(a, bbox.top, b - a, bbox.height);
      }));
    }

    lines(u) {
      this.clipped(u, (ctx, bbox) => this.plot.marks.forEach((mark, key) => {
        if (!mark.horizontal || this.hiddenMarks.has(key)) return;
        const y = u.valToPos(mark.horizontal.at, "y", true);
        ctx.beginPath();
        ctx.moveTo(bbox.left, y); ctx.lineTo(bbox.left + bbox.width, y);
        // On a lane of the ground's colour, or a dense curve would swallow it.
        ctx.strokeStyle = palette.ground;
        ctx.lineWidth = 2.8 * devicePixelRatio;
        ctx.stroke();
        this.dashed(ctx, mark.horizontal.colour);
      }));
    }

    dashed(ctx, colour) {
      ctx.strokeStyle = palette[colour];
      ctx.lineWidth = 1.6 * devicePixelRatio;
      ctx.setLineDash([4 * devicePixelRatio, 2 * devicePixelRatio]);
      ctx.stroke();
      ctx.setLineDash([]);
    }

    readOut(u) {
      const { plot } = this, idx = u.cursor.idx, off = u.cursor.left < 0 || idx == null;
      this.at.textContent = off ? "" : withUnit(number(this.data[0][idx]), plot.x.unit);
      plot.series.forEach((s, key) => {
        const values = this.indices[key].map(index => { const line = u.cursor.idxs[index]; return line == null ? null : this.data[index][line]; });
        this.value("series", key, off ? "" : withUnit(values.length > 1 ? values.map(number).join(" to ") : number(values[0]), plot.y.unit));
      });
    }
    value(kind, key, text) {
      this.figure.querySelector(`[data-${kind}="${key}"] + .value`).textContent = text;
    }

    // The zoom of one pane becomes that of its group; a pane shown whole resets the others to their own whole.
    share(u) {
      if (Pane.sharing || this.plot.group == null || !u.scales.x) return;
      Pane.sharing = true;
      const { min, max } = u.scales.x, whole = min === this.extent[0] && max === this.extent[1];
      for (const pane of drawn) if (pane !== this && pane.plot.group === this.plot.group) pane.zoom(whole ? pane.extent : [min, max]);
      Pane.sharing = false;
    }
    zoom([min, max]) { this.u.setScale("x", { min, max }); }

    connect() {
      const { figure, box, plot } = this, button = figure.querySelector(".range");
      button?.addEventListener("click", () => {
        this.fullRange = !this.fullRange;
        button.setAttribute("aria-pressed", this.fullRange);
        const { min, max } = this.u.scales.x;
        Pane.sharing = true;
        this.zoom([min, max]);
        Pane.sharing = false;
      });
      figure.querySelectorAll(".legend button").forEach(key => key.addEventListener("click", () => {
        const show = key.getAttribute("aria-pressed") === "false";
        key.setAttribute("aria-pressed", show);
        if (key.dataset.series != null) {
          this.indices[key.dataset.series].forEach(index => this.u.setSeries(index, { show }));
        } else {
          const mark = Number(key.dataset.mark);
          show ? this.hiddenMarks.delete(mark) : this.hiddenMarks.add(mark);
          this.u.redraw(false);
        }
      }));
      box.addEventListener("keydown", event => this.key(event));
      new ResizeObserver(() => root.classList.contains("printing") || this.u.setSize(this.size())).observe(box);
    }

    // Arrows move the cursor by a line (with shift by ten), + and − zoom about it, Escape shows everything.
    key(event) {
      const { u } = this, x = this.data[0], { min, max } = u.scales.x;
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (step) {
        const from = u.cursor.idx ?? u.valToIdx(min);
        const line = Math.max(0, Math.min(x.length - 1, from + step * (event.shiftKey ? 10 : 1)));
        u.setCursor({ left: u.valToPos(x[line], "x"), top: u.over.clientHeight / 2 }, true, true);
      } else if (event.key === "+" || event.key === "-") {
        const centre = u.cursor.idx == null ? (min + max) / 2 : x[u.cursor.idx], factor = event.key === "+" ? 0.5 : 2;
        this.zoom([Math.max(this.extent[0], centre - (centre - min) * factor), Math.min(this.extent[1], centre + (max - centre) * factor)]);
      } else if (event.key === "Escape") {
        this.zoom(this.extent);
      } else return;
      event.preventDefault();
    }

    size(limit = Infinity) {
      return { width: Math.max(160, Math.min(limit, this.box.clientWidth)), height: this.plot.height };
    }
  }

  document.querySelectorAll("figure[data-plot]").forEach(figure => drawn.push(new Pane(figure, page.plots[figure.dataset.plot])));

  const redraw = () => { readPalette(); drawn.forEach(pane => pane.u.redraw(false)); };
  dark.addEventListener("change", redraw);
  // Paper is white and some 680 pixels wide.
  addEventListener("beforeprint", () => {
    root.classList.add("printing");
    redraw();
    for (const pane of drawn) {
      const grid = pane.figure.closest(".plots"), across = Number(grid.className.match(/columns-(\d)/)[1]);
      pane.u.setSize(pane.size((680 - 26 * (across - 1)) / across));
    }
  });
  addEventListener("afterprint", () => {
    root.classList.remove("printing");
    redraw();
    drawn.forEach(pane => pane.u.setSize(pane.size()));
  });
})();
