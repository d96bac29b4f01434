// A page in use: every key of every legend, a drag, a double click, arrow keys, and figures as they are saved.
async function look(frame) {
  const page = frame.contentDocument, { MouseEvent, KeyboardEvent, HTMLAnchorElement, DOMParser } = frame.contentWindow;
  const figures = [...page.querySelectorAll("figure[data-plot]")], titled = figure => figure.querySelector("h3").textContent;
  const picture = figure => figure.querySelector("canvas").toDataURL();
  const seen = { plots: figures.length, dead: [], stuck: [], kept: [], broken: [], dashes: {}, whole: 0, cut: [] };
  await settled();

  // What would go to a file comes here.
  const files = [];
  HTMLAnchorElement.prototype.click = function () { files.push(this.href); };
  function saved(figure) {
    figure.querySelector(".save button").click();
    const svg = decodeURIComponent(files.pop().split(",").slice(1).join(","));
    const drawing = new DOMParser().parseFromString(svg, "image/svg+xml");
    if (drawing.querySelector("parsererror, img, script")) seen.broken.push(titled(figure));
    return drawing;
  }
  // Numbers along x, and what is written along y, where powers of ten may stand.
  function axes(figure) {
    const drawing = saved(figure), written = selector => [...drawing.querySelectorAll(selector)].map(text => text.textContent);
    return { x: written("text[text-anchor=middle]:not([transform])").map(parseFloat).filter(value => !isNaN(value)), y: written("text[text-anchor=end]") };
  }

  for (const figure of figures) {
    const drawing = saved(figure);
    seen.dashes[titled(figure)] = [...drawing.querySelectorAll("[clip-path] path[stroke-dasharray]")].map(path => path.getAttribute("stroke-dasharray"));
    // One plot of each section: every click draws anew all that stand with it.
    if (figure !== figure.closest("section").querySelector("figure[data-plot]")) continue;
    for (const key of figure.querySelectorAll(".legend button")) {
      const name = `${titled(figure)}: ${key.textContent}`, before = picture(figure), entries = drawing.querySelectorAll("g[transform]").length;
      key.click();
      await settled();
      if (key.getAttribute("aria-pressed") !== "false" || picture(figure) === before) seen.dead.push(name);
      if (saved(figure).querySelectorAll("g[transform]").length !== entries - 1) seen.kept.push(name);
      key.click();
      await settled();
      if (key.getAttribute("aria-pressed") !== "true" || picture(figure) !== before) seen.stuck.push(name);
    }
  }

  const [figure, fellow] = figures, over = figure.querySelector(".u-over");
  const first = figures.map(picture);
  function mouse(type, share) {
    const box = over.getBoundingClientRect();
    over.dispatchEvent(new MouseEvent(type, { bubbles: true, button: 0, clientX: box.left + share * box.width, clientY: box.top + 0.5 * box.height, movementX: 5 }));
  }
  seen.before = axes(figure);
  mouse("mousemove", 0.4); mouse("mousedown", 0.4); mouse("mousemove", 0.5); mouse("mousemove", 0.6); mouse("mouseup", 0.6);
  await settled();
  seen.zoomed = axes(figure);
  seen.fellow = axes(fellow);
  seen.read = figure.querySelector(".at").textContent;
  mouse("dblclick", 0.5);
  await settled();
  seen.altered = figures.filter((each, index) => picture(each) !== first[index]).map(titled);

  const box = figure.querySelector(".drawing"), press = key => box.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  press("ArrowRight");
  await settled();
  seen.arrow = figure.querySelector(".at").textContent;
  press("+");
  await settled();
  seen.plus = axes(figure);
  press("Escape");
  await settled();
  seen.altered.push(...figures.filter((each, index) => picture(each) !== first[index]).map(titled));

  for (const button of page.querySelectorAll(".range")) {
    const each = button.closest("figure"), before = picture(each);
    button.click();
    await settled();
    const whole = picture(each) !== before && button.getAttribute("aria-pressed") === "true";
    button.click();
    await settled();
    if (whole && picture(each) === before) seen.whole++; else seen.cut.push(titled(each));
  }

  figure.querySelectorAll(".save button")[1].click();
  for (let turn = 0; turn < 50 && !files.length; turn++) await settled();
  seen.png = (files.pop() ?? "").slice(0, 22);
  return seen;
}
