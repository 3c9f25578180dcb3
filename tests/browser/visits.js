// Opens the pages one after another in a frame, asks each what is wrong with it, and sends the answers.
"use strict";

const settled = async (frame) => {
  const { MathJax, document: page } = frame.contentWindow;
  await MathJax?.startup?.promise;
  await page.fonts.ready;
  const pictures = [...page.images];
  pictures.forEach((picture) => { picture.loading = "eager"; });
  await Promise.allSettled(pictures.map((picture) => picture.decode()));
};

const named = (element) => {
  const text = (element.textContent || element.src || "").trim().slice(0, 60);
  return `<${element.tagName.toLowerCase()}> ${JSON.stringify(text)}`;
};

const scrolls = (element, view) => ["auto", "scroll"].includes(view.getComputedStyle(element).overflowX);

function* overflowing(page, view) {
  const wide = page.documentElement.scrollWidth;
  if (wide <= view.innerWidth) return;
  const beyond = [...page.body.querySelectorAll("*")].filter(
    (element) => element.getBoundingClientRect().right > view.innerWidth + 1,
  );
  yield `it is ${wide} pixels wide: ${beyond.length ? named(beyond.at(-1)) : "?"}`;
}

function* cutOff(page, view, columns) {
  for (const block of page.querySelectorAll("pre")) {
    if (block.scrollWidth <= block.clientWidth + 1) continue;
    const longest = Math.max(...block.textContent.split("\n").map((line) => line.length));
    if (longest <= columns) yield `code of ${longest} columns does not fit: ${named(block)}`;
    else if (!scrolls(block, view)) yield `code is cut off: ${named(block)}`;
  }
}

function* rawFormulas(page, view) {
  const texts = page.createTreeWalker(page.body, view.NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const { data, parentElement } = texts.currentNode;
    if (parentElement.closest("pre, code, script, style, mjx-container")) continue;
    if (/\\[([]|\$\$|\\begin\{/.test(data)) yield `a formula is not set: ${data.trim().slice(0, 60)}`;
  }
  for (const wrong of page.querySelectorAll("mjx-merror, [data-mjx-error]")) {
    yield `a formula is wrong: ${wrong.dataset.mjxError || named(wrong)}`;
  }
}

function* brokenPictures(page) {
  for (const picture of page.images) {
    if (!picture.naturalWidth) yield `a picture is broken: ${picture.src}`;
  }
}

const complaints = (frame, columns) => {
  const view = frame.contentWindow;
  const page = view.document;
  return [
    ...overflowing(page, view),
    ...cutOff(page, view, columns),
    ...rawFormulas(page, view),
    ...brokenPictures(page),
  ];
};

const visited = async (address, width, columns) => {
  const frame = document.createElement("iframe");
  frame.width = width;
  frame.height = 900;
  frame.src = address;
  const loaded = new Promise((resolve) => { frame.onload = resolve; });
  document.body.append(frame);
  await loaded;
  await settled(frame);
  const found = complaints(frame, columns);
  const formulas = frame.contentWindow.document.querySelectorAll("mjx-container").length;
  frame.remove();
  return { complaints: found, formulas };
};

const visit = async ({ addresses, width, columns }) => {
  const answers = {};
  for (const address of addresses) {
    try {
      answers[address] = await visited(address, width, columns);
    } catch (error) {
      answers[address] = { complaints: [`it cannot be asked: ${error}`], formulas: 0 };
    }
  }
  await fetch("/answers", { method: "POST", body: JSON.stringify(answers) });
};
