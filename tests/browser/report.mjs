// Opens pages of `detp report` in a real browser and looks at what a reader needs of them.
//
//     node report.mjs CHROMIUM FOLDER_OF_PICTURES PAGE.html…
//
// The packages are those of package.json, found from the working directory. Prints what is wrong, and returns 1 if anything is.
import { createRequire } from "node:module";
import { readFileSync, mkdirSync } from "node:fs";
import { basename, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(resolve("package.json"));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
const [program, pictures, ...pages] = process.argv.slice(2);
const faults = [];
const check = (holds, what) => { if (!holds) faults.push(what); };

// The words of each row of a figure's table, as a point of its chart says them.
const figuresOf = (page) => page.evaluate(() =>
  [...document.querySelectorAll("figure")].map((figure) => {
    const head = [...figure.querySelectorAll("thead th")].map((one) => one.textContent);
    const rows = [...figure.querySelectorAll("tbody tr")].map((row) => {
      const cells = [...row.children].map((one) => one.textContent);
      const rest = cells.slice(1).map((cell, i) => cell && `${head[i + 1]} ${cell}`).filter(Boolean).join(", ");
      return cells[0] + (rest && `: ${rest}`);
    });
    return { title: figure.querySelector("summary").textContent, rows, values: [...figure.querySelectorAll("[data-value]")].map((one) => one.dataset.value) };
  }));

async function keyboard(page, name) {
  const charts = await page.locator(".chart").count();
  for (let i = 0; i < charts; ++i) {
    const chart = page.locator(".chart").nth(i);
    const values = await chart.locator("[data-value]").evaluateAll((all) => all.map((one) => one.dataset.value));
    await chart.focus();
    const read = [];
    for (let step = 0; step < values.length; ++step) {
      await page.keyboard.press(step % 2 ? "ArrowDown" : "ArrowRight");
      read.push(await page.locator("figure").nth(i).locator("output").textContent());
    }
    check(read.join("|") === values.join("|"), `${name}: the arrow keys do not read all values of chart ${i + 1}`);
    await page.keyboard.press("Home");
    check(await page.locator("figure").nth(i).locator("output").textContent() === values[0], `${name}: Home is not the first value`);
  }
}

async function look(browser, path, scheme, width) {
  const name = `${basename(path)} ${scheme} ${width}`;
  const context = await browser.newContext({ colorScheme: scheme, viewport: { width, height: 900 } });
  context.setDefaultTimeout(0);  // ctest has the only limit
  const page = await context.newPage();
  const requests = [];
  page.on("request", (one) => { if (!one.url().startsWith("data:")) requests.push(one.url()); });
  page.on("console", (one) => check(one.type() !== "error" && one.type() !== "warning", `${name}: console: ${one.text()}`));
  page.on("pageerror", (one) => check(false, `${name}: ${one.message}`));
  page.on("dialog", (one) => { check(false, `${name}: a dialog: ${one.message()}`); one.dismiss(); });
  await page.goto(pathToFileURL(resolve(path)).href);
  check(requests.length === 1, `${name}: requests: ${requests}`);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  check(wide <= 0, `${name}: ${wide} points wider than the window`);
  await page.screenshot({ path: `${pictures}/${basename(path, ".html")}-${width}-${scheme}.png`, fullPage: true });
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  for (const one of found.violations) check(false, `${name}: ${one.id}: ${one.help}: ${one.nodes[0].html.slice(0, 120)}`);
  if (scheme === "light" && width === 1280) {
    for (const figure of await figuresOf(page)) {
      const rows = new Set(figure.rows);
      for (const value of figure.values) check(rows.has(value), `${name}: ${figure.title} has no row "${value}"`);
      check(figure.values.length > 0, `${name}: ${figure.title}: no values`);
    }
    await keyboard(page, name);
    const facts = await page.evaluate(() => ({
      lang: document.documentElement.lang,
      levels: [...document.querySelectorAll("h1,h2,h3,h4")].map((one) => Number(one.tagName[1])),
      schema: JSON.parse(document.getElementById("answer").textContent).schema.name,
      badPictures: [...document.querySelectorAll("svg")].filter((one) =>
        new DOMParser().parseFromString(one.outerHTML, "image/svg+xml").querySelector("parsererror")).length
        + [...document.images].filter((one) => one.naturalWidth < 100).length,
    }));
    check(facts.lang === "en", `${name}: no language`);
    check(facts.levels[0] === 1 && facts.levels.every((one, i) => i === 0 || (one > 1 && one <= facts.levels[i - 1] + 1)), `${name}: headings ${facts.levels}`);
    check(facts.schema === "detp.report", `${name}: the answer's schema is ${facts.schema}`);
    check(facts.badPictures === 0, `${name}: ${facts.badPictures} pictures are not XML, or not shown`);
    // On paper (A4 without margins of 12 mm), nothing may be cut off.
    await page.emulateMedia({ media: "print" });
    await page.setViewportSize({ width: 703, height: 1000 });
    await page.evaluate(() => document.querySelectorAll("details").forEach((one) => { one.open = true; }));
    const cut = await page.evaluate(() => [...document.querySelectorAll("body *")]
      .filter((one) => !one.closest("svg") && one.getClientRects().length && one.getBoundingClientRect().right > 704)
      .map((one) => one.tagName + "." + one.className + " " + one.textContent.slice(0, 40)));
    check(cut.length === 0, `${name}: printed, ${cut.length} elements are cut: ${cut.slice(0, 3)}`);
    await page.pdf({ path: `${pictures}/${basename(path, ".html")}.pdf`, format: "A4", margin: { top: "12mm", bottom: "12mm", left: "12mm", right: "12mm" } });
  }
  await context.close();
}

async function withoutScripts(browser, path) {
  const context = await browser.newContext({ javaScriptEnabled: false });
  context.setDefaultTimeout(0);  // ctest has the only limit
  const page = await context.newPage();
  await page.goto(pathToFileURL(resolve(path)).href);
  check(await page.locator("svg").count() >= 1 && await page.locator(".card").count() >= 1, `${basename(path)}: empty without scripts`);
  await context.close();
}

mkdirSync(pictures, { recursive: true });
const browser = await chromium.launch({ executablePath: program, args: ["--no-sandbox", "--disable-dev-shm-usage"], timeout: 0 });
for (const [index, path] of pages.entries()) {
  // The first page at all widths; the others have the same layout.
  for (const scheme of ["light", "dark"])
    for (const width of index === 0 ? [360, 390, 1280, 2000] : [390, 1280]) await look(browser, path, scheme, width);
  await withoutScripts(browser, path);
}
await browser.close();
for (const fault of faults) console.log(fault);
process.exit(faults.length ? 1 : 0);
