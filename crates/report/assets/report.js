// Draws the plots of a report page from the JSON in it: one uPlot per figure, cursor and zoom shared within a group.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("plot-data").textContent);
  const columns = page.columns.map(column => Array.isArray(column) ? column
    : Array.from({ length: column.count }, (_, line) => column.from + line * column.step));
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const GUTTER = 52;
  const dashes = { dashed: [6, 4], dotted: [2, 3] };
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
      if (plain) return String(Number(v.toPrecision(3))); // the first tick is the low end itself, whatever it is
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
      this.section = figure.closest("section");
      this.box = figure.querySelector(".drawing");
      this.at = figure.querySelector(".at");
      this.fullRange = !plot.first;
      this.hiddenMarks = new Set();
      this.cyclic = plot.y.unit === "°";
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
        ...this.size(), series, bands, legend: { show: false }, padding: [8, 18, 0, 0],
        scales: {
          x: { time: false, distr: log(plot.x) ? 3 : 1, range: (u, low, high) => startable(low == null || low <= this.data[0][0] && high >= this.data[0][this.data[0].length - 1] ? this.extent : low < high ? [low, high] : [low - 0.5, low + 0.5], plot.x.spacing) },
          y: { distr: log(plot.y) ? 3 : 1, range: (u, low, high) => startable(this.ordinates(u, low, high), plot.y.spacing) },
        },
        axes: [
          axis(log(plot.x) ? { filter: decades } : {}, { label: title(plot.x), size: 26, values: log(plot.x) ? logTicks : linearTicks, space: 60 }),
          axis(log(plot.y) ? { filter: decades } : {}, { label: title(plot.y), ...(this.cyclic ? { incrs: [1, 2, 5, 10, 15, 30, 45, 90, 180] } : {}), values: log(plot.y) ? logTicks : linearTicks, space: 28,
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
      if (this.cyclic) common.gaps = (u, index, from, to, gaps) => this.turns(u, index, from, to, gaps);
      if (s.style in dashes) return { ...common, dash: dashes[s.style] };
      if (s.style === "points") return { ...common, paths: () => null, points: { show: true, size: 5, stroke, fill: stroke, width: 0 } };
      if (s.style === "band") return { ...common, width: 0, stroke: "transparent", points: { show: false } };
      return common;
    }

    // A phase that leaves its turn at one end and comes back at the other is not drawn across.
    turns(u, index, from, to, gaps) {
      const x = line => Math.round(u.valToPos(this.data[0][line], "x", true)), values = this.data[index];
      for (let line = from + 1; line <= to; line++) if (this.leaps(values, line)) gaps.push([x(line - 1) - 1, x(line) + 1]);
      return gaps.sort((a, b) => a[0] - b[0]);
    }
    leaps(values, line) { return this.cyclic && values[line] != null && values[line - 1] != null && Math.abs(values[line] - values[line - 1]) > 180; }

    // A line between two gaps has no neighbour to be joined to: it is drawn as a point.
    isolated(index) {
      const values = this.data[index], found = [];
      const gap = line => line < 0 || line >= values.length || values[line] === null;
      for (let line = 0; line < values.length; line++) if (values[line] != null && gap(line - 1) && gap(line + 1)) found.push(line);
      return found;
    }

    ordinates(u, low, high) {
      const { plot } = this;
      if (plot.held) return plot.held;
      // The scale of abscissae still has its ends from before a zoom; these are the lines in view after it.
      const x = this.data[0], [from, to] = [u.series[0].min ?? x[0], u.series[0].max ?? x[x.length - 1]];
      const zoomed = from > x[0] || to < x[x.length - 1];
      if (!this.fullRange && !zoomed) return plot.first;
      const log = plot.y.spacing === "logarithmic";
      let extent = low == null ? null : [low, high];
      if (!this.fullRange) extent = this.inView(u, from, to, log) || extent;
      for (const mark of plot.marks) if (mark.horizontal && (!log || mark.horizontal.at > 0)) {
        const at = mark.horizontal.at;
        extent = extent ? [Math.min(extent[0], at), Math.max(extent[1], at)] : [at, at];
      }
      return extent ? padded(extent, plot.y.spacing) : log ? [1, 10] : [-1, 1];
    }

    // What the curves that are shown reach between two abscissae; bands do not count.
    inView(u, from, to, log) {
      const x = this.data[0];
      let extent = null;
      this.plot.series.forEach((s, key) => {
        if (s.style === "band" || !u.series[this.indices[key][0]].show) return;
        const values = this.data[this.indices[key][0]].filter((v, line) => v != null && x[line] >= from && x[line] <= to);
        if (!values.length) return;
        const [a, b] = this.plot.percentiles ? robustExtent(values, this.plot.percentiles, log) : [Math.min(...values), Math.max(...values)];
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
      // A curve is hidden in all panes of the section that have it.
      figure.querySelectorAll(".legend button").forEach(key => key.addEventListener("click", () => {
        const show = key.getAttribute("aria-pressed") === "false", alike = pane => pane === this || pane.section === this.section && plot.group != null && pane.plot.group === plot.group;
        const name = this.keys().get(key);
        for (const pane of drawn) if (alike(pane)) pane.toggle(name, show);
      }));
      box.addEventListener("keydown", event => this.key(event));
      new ResizeObserver(() => root.classList.contains("printing") || this.u.setSize(this.size())).observe(box);
    }

    // What each key stands for: several may have one label (bands that are held out), and a mark is the one that has the same value elsewhere.
    keys() {
      const names = new Map(), counts = {};
      for (const key of this.figure.querySelectorAll(".legend button")) {
        const name = key.dataset.series != null ? "curve " + key.textContent : `mark ${key.textContent} ${key.nextElementSibling.textContent}`;
        counts[name] = (counts[name] ?? 0) + 1;
        names.set(key, `${name} ${counts[name]}`);
      }
      return names;
    }

    toggle(name, show) {
      for (const [key, own] of this.keys()) if (own === name) {
        key.setAttribute("aria-pressed", show);
        if (key.dataset.series != null) {
          this.indices[key.dataset.series].forEach(index => this.u.setSeries(index, { show }));
        } else {
          const mark = Number(key.dataset.mark);
          show ? this.hiddenMarks.delete(mark) : this.hiddenMarks.add(mark);
          this.u.redraw(false);
        }
      }
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

  const escaped = text => String(text).replace(/[&<>"]/g, character => `&#${character.charCodeAt(0)};`);

  // A pane as it is seen, zoomed and without what is hidden, as a drawing of its own.
  function drawingOf(pane) {
    const { u, plot, data, figure } = pane, [left, top, wide, high] = ["left", "top", "width", "height"].map(key => u.bbox[key] / devicePixelRatio);
    const px = value => (left + u.valToPos(value, "x")).toFixed(1), py = value => (top + u.valToPos(value, "y")).toFixed(1);
    const path = (colour, d, more = "") => `<path fill="none" stroke="${palette[colour]}" stroke-width="1.4" ${more} d="${d}"/>`;
    const text = (x, y, words, more = "") => `<text x="${x}" y="${y}" ${more}>${escaped(words)}</text>`;
    const inside = [], width = u.width, markDashes = 'stroke-dasharray="4 2"';
    plot.marks.forEach((mark, key) => {
      const { shaded, vertical, horizontal } = mark;
      if (pane.hiddenMarks.has(key)) return;
      if (shaded) inside.push(`<rect x="${px(shaded.from)}" y="${top}" width="${(px(shaded.to) - px(shaded.from)).toFixed(1)}" height="${high}" fill="${palette.shade}"/>`);
      if (vertical) inside.push(path(vertical.colour, `M${px(vertical.at)} ${top}v${high}`, markDashes));
      if (horizontal) inside.push(path(horizontal.colour, `M${left} ${py(horizontal.at)}h${wide}`, markDashes));
    });
    const { min, max } = u.scales.x, first = Math.max(0, u.valToIdx(min) - 1), last = Math.min(data[0].length - 1, u.valToIdx(max) + 1);
    const order = plot.series.map((s, key) => [s, key]).sort(([a], [b]) => (b.style === "band") - (a.style === "band"));
    for (const [s, key] of order) {
      const [low, upper = low] = pane.indices[key], runs = [[]];
      if (!u.series[low].show) continue;
      for (let line = first; line <= last; line++) {
        if (data[low][line] === undefined) continue;
        if (pane.leaps(data[low], line)) runs.push([]);
        if (data[low][line] === null || data[upper][line] == null) runs.push([]); else runs[runs.length - 1].push(line);
      }
      const at = index => line => `${px(data[0][line])} ${py(data[index][line])}`;
      for (const run of runs) if (run.length) {
        if (s.style === "band") inside.push(`<path fill="${palette[s.colour]}" opacity="0.26" d="M${[...run.map(at(low)), ...run.reverse().map(at(upper))].join("L")}Z"/>`);
        else if (s.style === "points") inside.push(path(s.colour, run.map(line => `M${at(low)(line)}h0`).join(""), 'stroke-linecap="round" style="stroke-width:5"'));
        else inside.push(path(s.colour, `M${run.map(at(low)).join("L")}${run.length > 1 ? "" : "h1"}`, s.style in dashes ? `stroke-dasharray="${dashes[s.style].join(" ")}"` : ""));
      }
    }
    const outside = [], [abscissae, ordinates] = u.axes, labels = axis => axis._splits.map((split, index) => [split, axis._values[index]]).filter(([split]) => split != null);
    for (const [split, label] of labels(abscissae)) outside.push(path("grid", `M${px(split)} ${top}v${high}`), text(px(split), top + high + 17, label ?? "", 'text-anchor="middle"'));
    for (const [split, label] of labels(ordinates)) outside.push(path("grid", `M${left} ${py(split)}h${wide}`), text(left - 6, +py(split) + 4, label ?? "", 'text-anchor="end"'));
    outside.push(text(left + wide / 2, u.height - 3, abscissae.label, 'text-anchor="middle"'), text(0, 0, ordinates.label, `text-anchor="middle" transform="translate(13 ${top + high / 2}) rotate(-90)"`));
    let x = left, y = 40;
    const entries = [...figure.querySelectorAll(".legend button[aria-pressed=true]")].map(key => {
      const words = key.textContent + (key.dataset.mark ? " " + key.nextElementSibling.textContent : ""), room = 44 + 7 * words.length;
      if (x > left && x + room > width) { x = left; y += 19; }
      const entry = `<g transform="translate(${x} ${y - 9})">${coloured(new XMLSerializer().serializeToString(key.querySelector("svg")))}</g>` + text(x + 28, y, words);
      x += room;
      return entry;
    });
    const total = u.height + y + 8, title = figure.querySelector("h3").textContent;
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${total}" viewBox="0 0 ${width} ${total}" font-family="system-ui,'DejaVu Sans',sans-serif" font-size="12" fill="${palette.ink}">`
      + `<title>${escaped(title)}</title><rect width="${width}" height="${total}" fill="${palette.ground}"/>${text(left, 18, title, 'font-size="14" font-weight="600"')}${entries.join("")}`
      + `<g transform="translate(0 ${y + 8})">${outside.join("")}<clipPath id="area"><rect x="${left}" y="${top}" width="${wide}" height="${high}"/></clipPath><g clip-path="${"url"}(#area)">${inside.join("")}</g>${path("rule", `M${left} ${top}h${wide}v${high}h${-wide}z`)}</g></svg>`;
  }
  // Markup with the page's variables replaced by the colours that they have now.
  const coloured = markup => markup.replace(/var\(--([\w-]+)[^)]*\)/g, (_, name) => palette[name]);
  function sketched(figure) {
    const svg = figure.querySelector("svg"), [, , width, height] = svg.getAttribute("viewBox").split(" "), copy = svg.cloneNode(true);
    copy.setAttribute("width", width); copy.setAttribute("height", height);
    return coloured(new XMLSerializer().serializeToString(copy)).replace(">", `><rect width="100%" height="100%" fill="${palette.ground}"/>`);
  }

  function save(name, href) {
    const link = document.createElement("a");
    link.download = name.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") + (href.startsWith("data:image/png") ? ".png" : ".svg");
    link.href = href;
    link.click();
  }
  function addButtons(place, name, draw) {
    const bar = document.createElement("span");
    bar.className = "save";
    for (const kind of ["SVG", "PNG"]) {
      const button = document.createElement("button");
      button.type = "button"; button.textContent = kind; button.title = `Save this figure as ${kind}`;
      button.setAttribute("aria-label", `Save ${name} as ${kind}`);
      button.addEventListener("click", () => {
        const svg = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(draw());
        if (kind === "SVG") return save(name, svg);
        const image = new Image();
        image.onload = () => {
          const canvas = document.createElement("canvas");
          canvas.width = 2 * image.width; canvas.height = 2 * image.height;
          canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
          save(name, canvas.toDataURL("image/png"));
        };
        image.src = svg;
      });
      bar.append(button);
    }
    place.append(bar);
  }

  // A mode shape moves while it is asked to, a period in two seconds.
  function addMotion(svg) {
    const middle = Number(svg.dataset.middle), parts = [], at = (y, share) => (middle + (y - middle) * share).toFixed(1);
    const moves = (selector, name, moved) => svg.querySelectorAll(selector).forEach(element => {
      const own = element.getAttribute(name);
      parts.push(share => element.setAttribute(name, moved(own, share)));
    });
    moves("polyline", "points", (own, share) => own.replace(/,([^ ]+)/g, (_, y) => "," + at(y, share)));
    moves("circle", "cy", at);
    moves(".shape-stem", "y2", at);
    const button = document.createElement("button");
    button.type = "button"; button.textContent = "move"; button.setAttribute("aria-pressed", "false");
    let begun = null;
    const step = now => {
      if (begun === null) return parts.forEach(part => part(1));
      parts.forEach(part => part(Math.cos(Math.PI * (now - begun) / 1000)));
      requestAnimationFrame(step);
    };
    button.addEventListener("click", () => {
      begun = begun === null ? performance.now() : null;
      button.setAttribute("aria-pressed", begun !== null);
      requestAnimationFrame(step);
    });
    svg.closest("figure").querySelector(".save").prepend(button);
  }

  document.querySelectorAll("figure[data-plot]").forEach(figure => drawn.push(new Pane(figure, page.plots[figure.dataset.plot])));
  for (const pane of drawn) addButtons(pane.figure.querySelector(".plot-head"), pane.figure.querySelector("h3").textContent, () => drawingOf(pane));
  document.querySelectorAll("figure.sketch").forEach(figure => addButtons(figure, figure.closest("section").id, () => sketched(figure)));
  document.querySelectorAll("svg[data-middle]").forEach(addMotion);

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
