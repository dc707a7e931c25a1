"use strict";
(() => {
  // Colours: as the system, light, dark. A page that may not remember forgets.
  const root = document.documentElement;
  const button = document.getElementById("theme");
  const names = { "": "as the system", light: "light", dark: "dark" };
  const remembered = () => { try { return localStorage.getItem("sahara-theme") || ""; } catch { return ""; } };
  const show = (theme) => {
    if (theme in names && theme) root.dataset.theme = theme; else delete root.dataset.theme;
    button.querySelector("span").textContent = names[theme] || names[""];
  };
  show(remembered());
  button.hidden = false;
  button.addEventListener("click", () => {
    const order = ["", "light", "dark"];
    const next = order[(order.indexOf(root.dataset.theme || "") + 1) % order.length];
    try { localStorage.setItem("sahara-theme", next); } catch { /* shown all the same */ }
    show(next);
  });

  // Tables: a click on a heading sorts; the same one again turns round. What has no number is last.
  const key = (row, column) => {
    const cell = row.cells[column];
    return "key" in cell.dataset ? Number(cell.dataset.key) : null;
  };
  for (const head of document.querySelectorAll("thead th > button")) {
    head.addEventListener("click", () => {
      const th = head.parentElement, table = th.closest("table"), body = table.tBodies[0], column = th.cellIndex;
      const rows = [...body.rows];
      const numbers = rows.some((row) => key(row, column) !== null);
      const first = numbers ? "descending" : "ascending";
      const other = numbers ? "ascending" : "descending";
      const order = th.getAttribute("aria-sort") === first ? other : first;
      const sign = order === "ascending" ? 1 : -1;
      rows.sort((a, b) => {
        if (!numbers) return sign * a.cells[column].textContent.localeCompare(b.cells[column].textContent, "en");
        const x = key(a, column), y = key(b, column);
        if (x === null || y === null) return (x === null) - (y === null);
        return sign * (x - y);
      });
      for (const each of table.querySelectorAll("thead th")) each.setAttribute("aria-sort", each === th ? order : "none");
      body.append(...rows);
    });
  }

  // Paper has no summary to click on.
  const folds = document.querySelectorAll("details");
  let closed = [];
  addEventListener("beforeprint", () => { closed = [...folds].filter((fold) => !fold.open); closed.forEach((fold) => { fold.open = true; }); });
  addEventListener("afterprint", () => closed.forEach((fold) => { fold.open = false; }));
})();
