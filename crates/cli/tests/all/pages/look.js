// What a page shows: its plots at a desk, its width in a narrow window, and what sticks out of a sheet of A4.
async function look(frame) {
  const page = frame.contentDocument, all = selector => [...page.querySelectorAll(selector)];
  const named = element => `${element.tagName} ${element.className.baseVal ?? element.className}: ${element.textContent.slice(0, 60)}`;
  const right = element => element.getBoundingClientRect().right;
  await settled();
  const policy = page.querySelector("meta[http-equiv=Content-Security-Policy]");
  const seen = {
    title: page.title,
    policy: policy && policy.content,
    foot: all("footer").length,
    images: all("img").length,
    scripts: all("script:not([type])").length,
    drawings: all("svg").length,
    plots: all(".drawing").length,
    undrawn: all(".drawing").filter(box => box.querySelectorAll("canvas").length !== 1).map(named),
  };

  // Opened at this width: nothing tells a page without a screen that its frame has changed.
  const narrow = frame.cloneNode();
  narrow.style.width = "390px";
  const loaded = new Promise(done => narrow.addEventListener("load", done));
  document.body.append(narrow);
  await loaded;
  await settled();
  seen.narrow = narrow.contentDocument.documentElement.scrollWidth;
  narrow.remove();

  // Between margins of 14 mm a sheet of A4 is 687 pixels wide.
  frame.style.width = "687px";
  let rules = 0;
  for (const sheet of page.styleSheets) for (const rule of sheet.cssRules) if (rule.media) {
    if (rule.media.mediaText === "print") rules++;
    rule.media.mediaText = rule.media.mediaText.replace(/^print/, "all").replace(/^screen/, "speech");
  }
  frame.contentWindow.dispatchEvent(new Event("beforeprint"));
  await settled();
  seen.rules = rules;
  const shown = all("main *").filter(element => element.getBoundingClientRect().width > 0 && (element.matches("canvas") || !element.closest(".uplot")));
  const hides = element => frame.contentWindow.getComputedStyle(element).overflowX !== "visible" && !element.closest("svg");
  seen.lost = [
    ...shown.filter(element => right(element) > 688).map(named),
    ...shown.filter(element => hides(element) && element.scrollWidth > element.clientWidth + 1).map(named),
    ...shown.filter(element => element.matches("svg text") && right(element) > right(element.closest("svg")) + 1).map(named),
  ];
  return seen;
}
