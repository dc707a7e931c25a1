"use strict";
// Pictures of one scene: two of them one upon the other, and the ray of a pixel in every structure.
(() => {
  const number = (value, digits) => value === null || value === undefined ? "" : digits ? value.toFixed(digits) : String(value);
  const cell = (tag, text, className) => {
    const element = document.createElement(tag);
    element.textContent = text;
    if (className) element.className = className;
    return element;
  };
  const between = (value, low, high) => Math.min(Math.max(value, low), high);

  // Left and right of a border that a slider moves. Tells whether a place, as a share of the width, is on the border.
  const overlaid = (overlay, pictures) => {
    const stage = overlay.querySelector(".stage"), range = overlay.querySelector("input");
    const images = stage.querySelectorAll("img"), selects = overlay.querySelectorAll("select");
    stage.style.aspectRatio = `${pictures[0].width} / ${pictures[0].height}`;
    overlay.hidden = false;
    if (!range) {
      images[0].src = pictures[0].src;
      images[0].alt = pictures[0].alt;
      images[1].remove();
      stage.querySelector(".divide").remove();
      return () => false;
    }
    const draw = () => {
      images.forEach((image, side) => {
        const chosen = pictures[selects[side].value];
        image.src = chosen.src;
        image.alt = chosen.alt;
      });
      stage.style.setProperty("--cut", range.value + "%");
      range.setAttribute("aria-valuetext",
        `${range.value} % ${pictures[selects[0].value].dataset.name}, the rest ${pictures[selects[1].value].dataset.name}`);
    };
    const share = (event) => {
      const box = stage.getBoundingClientRect();
      return (event.clientX - box.left) / box.width;
    };
    const onBorder = (event) => Math.abs(share(event) - range.value / 100) * stage.clientWidth < 12;
    let dragged = false;
    stage.addEventListener("pointerdown", (event) => {
      dragged = onBorder(event);
      if (dragged) stage.setPointerCapture(event.pointerId);
    });
    stage.addEventListener("pointermove", (event) => {
      stage.classList.toggle("on-border", dragged || onBorder(event));
      if (!dragged) return;
      range.value = Math.round(share(event) * 100);
      draw();
    });
    stage.addEventListener("pointerup", () => { dragged = false; });
    range.addEventListener("input", draw);
    selects.forEach((select) => select.addEventListener("change", draw));
    draw();
    return onBorder;
  };

  // The rays of some pixels.
  const inspected = (figure, panel, data, stage, pictures, onBorder) => {
    const [width, height] = data.size;
    const places = data.pixels.map((pixel) => [pixel % width, Math.floor(pixel / width)]);
    const [status, code, body] = [".pixel", "code", "tbody"].map((part) => panel.querySelector(part));
    let chosen = 0;

    const row = (label, answer, counts) => {
      const wrong = typeof answer.at(-1) === "string" ? answer.at(-1) : "";
      const [t, triangle, u, v] = answer.length > 3 ? answer : [];
      const line = document.createElement("tr");
      const head = cell("th", label);
      head.scope = "row";
      if (wrong) head.append(" ", cell("span", wrong, "wrong"));
      line.append(head, ...counts.map((count) => cell("td", number(count))));
      if (answer.length > 3) line.append(cell("td", number(t)), cell("td", number(triangle)), cell("td", number(u, 9)), cell("td", number(v, 9)));
      else line.append(cell("td", "no hit"), cell("td", ""), cell("td", ""), cell("td", ""));
      return line;
    };
    const show = () => {
      const [column, line] = places[chosen], truth = data.truths[chosen];
      figure.style.setProperty("--x", `${(column + 0.5) / width * 100}%`);
      figure.style.setProperty("--y", `${(line + 0.5) / height * 100}%`);
      const meets = truth.length ? `its ray meets triangle ${truth[1]} at t = ${truth[0]}` : "its ray meets nothing";
      status.textContent = `Pixel ${column}, ${line} from the top left: ${meets}.`;
      body.replaceChildren(row("exact arithmetic", truth, ["", "", ""]), ...data.structures.map((structure) =>
        row(structure.label, data.answers[chosen][structure.answers[chosen]],
          [structure.nodes, structure.leaves, structure.tests].map((counts) => counts[chosen]))));
      code.textContent = `${data.command} "${data.rays[chosen]}"`;
    };
    const choose = (pixel) => { chosen = pixel; show(); };
    const least = (cost) => {
      let best = -1, lowest = Infinity;
      places.forEach((place, i) => {
        const own = cost(place);
        if (own < lowest) [best, lowest] = [i, own];
      });
      return best;
    };
    const nearest = (x, y) => least(([column, line]) => (column - x) ** 2 + (line - y) ** 2);
    // The next one in a direction: sideways counts twice.
    const next = (dx, dy) => {
      const [x, y] = places[chosen];
      const found = least(([column, line]) => {
        const [along, aside] = dx ? [(column - x) * dx, Math.abs(line - y)] : [(line - y) * dy, Math.abs(column - x)];
        return along > 0 ? along + 2 * aside : Infinity;
      });
      if (found >= 0) chosen = found;
    };
    const copy = async () => {
      try {
        await navigator.clipboard.writeText(code.textContent);
        status.textContent = "Command copied.";
      } catch {
        getSelection().selectAllChildren(code);
        status.textContent = "Command selected: copy it.";
      }
    };

    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    stage.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.key in arrows) {
        for (let step = 0; step < (event.shiftKey ? 8 : 1); step++) next(...arrows[event.key]);
        show();
      } else if (event.key === "PageDown" || event.key === "PageUp") {
        choose(between(chosen + (event.key === "PageDown" ? 1 : -1), 0, places.length - 1));
      } else if (event.key === "Home" || event.key === "End") {
        choose(event.key === "Home" ? 0 : places.length - 1);
      } else if (event.key === "Enter") {
        copy();
      } else {
        return;
      }
      event.preventDefault();
    });
    const ask = (event, element) => {
      const box = element.getBoundingClientRect();
      choose(nearest((event.clientX - box.left) / box.width * width - 0.5, (event.clientY - box.top) / box.height * height - 0.5));
    };
    stage.addEventListener("pointerdown", (event) => { if (!onBorder(event)) ask(event, stage); });
    pictures.forEach((picture) => picture.addEventListener("pointerdown", (event) => ask(event, picture)));
    panel.querySelector("button").addEventListener("click", copy);

    stage.tabIndex = 0;
    stage.setAttribute("role", "application");
    stage.setAttribute("aria-label", "Pixels: arrows move, Page Up and Page Down step through all, Enter copies the command");
    panel.querySelector(".which").textContent = data.which;
    panel.hidden = false;
    figure.classList.add("inspected");
    choose(nearest(width / 2, height / 2));
  };

  for (const overlay of document.querySelectorAll("[data-overlay]")) {
    const figure = overlay.closest("figure"), pictures = [...figure.querySelectorAll(".maps img")];
    const onBorder = overlaid(overlay, pictures);
    const data = JSON.parse(figure.querySelector("script").textContent);
    inspected(figure, figure.querySelector(".inspector"), data, overlay.querySelector(".stage"), pictures, onBorder);
  }
})();
