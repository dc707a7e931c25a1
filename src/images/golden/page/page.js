"use strict";
// Pictures of one comparison: two of them one upon the other, and the values of a pixel.
(() => {
  const types = { Uint8: Uint8Array, Uint16: Uint16Array, Uint32: Uint32Array, Float32: Float32Array };
  const between = (value, low, high) => Math.min(Math.max(value, low), high);

  // Scripts hand in the values of pixels, since a page from a file may not read those of a picture.
  // They are large: each is loaded when its comparison is seen.
  const waiting = new Map();
  window.saharaValues = (number, data) => {
    const read = (side) => {
      if (!side) return null;
      const bytes = Uint8Array.from(atob(side.base64), (c) => c.charCodeAt(0));
      return { ...side, values: new types[side.type](bytes.buffer) };
    };
    waiting.get(number)({ expected: read(data.expected), actual: read(data.actual) });
  };
  const load = (number, file) => new Promise((done) => {
    waiting.set(number, done);
    const script = document.createElement("script");
    script.src = file;
    document.head.append(script);
  });
  const said = (side, [column, row]) => {
    const [width, height] = side.size;
    if (column >= width || row >= height) return "no pixel";
    const at = (row * width + column) * side.channels;
    const values = [...side.values.subarray(at, at + side.channels)];
    if (side.type === "Uint32") return values[0] === 0xffffffff ? "no triangle" : `triangle ${values[0]}`;
    return values.map((value) => side.type === "Float32" ? Number(value.toPrecision(9)) : value).join(", ");
  };

  const start = (viewer) => {
    const { number, size, worst, values: file } = viewer.dataset;
    const [width, height] = size.split(",").map(Number), worstPixel = worst.split(",").map(Number);
    const [stage, range, status] = [".stage", "input", ".pixel"].map((part) => viewer.querySelector(part));
    const images = stage.querySelectorAll("img"), selects = viewer.querySelectorAll("select");
    const buttons = Object.fromEntries([...viewer.querySelectorAll("button")].map((button) => [button.dataset.do, button]));
    let pixel = worstPixel, values = null, asked = false, zoomed = false, blinking = 0, cut = 50;

    const draw = () => {
      images.forEach((image, side) => { image.src = selects[side].value; });
      // 16 pixels of the picture, or more of a large one, fill the stage.
      const scale = zoomed ? Math.max(Math.min(width, height) / 16, 4) : 1;
      const place = (at, all) => (at + 0.5) / all;
      const shift = (share) => zoomed ? between(0.5 - share * scale, 1 - scale, 0) : 0;
      const [x, y] = [place(pixel[0], width), place(pixel[1], height)], [left, top] = [shift(x), shift(y)];
      stage.style.setProperty("--zoom", `translate(${left * 100}%, ${top * 100}%) scale(${scale})`);
      stage.style.setProperty("--x", `${(left + x * scale) * 100}%`);
      stage.style.setProperty("--y", `${(top + y * scale) * 100}%`);
      stage.style.setProperty("--cut", `${cut}%`);
      stage.classList.toggle("enlarged", scale * stage.clientWidth > width);
      const names = [...selects].map((select) => select.selectedOptions[0].text);
      range.setAttribute("aria-valuetext", `${cut} % ${names[0]}, the rest ${names[1]}`);
      const at = `Column ${pixel[0]}, row ${pixel[1]}`;
      const sides = values && Object.entries(values).filter(([, side]) => side);
      status.textContent = sides ? `${at}: ${sides.map(([name, side]) => `${name} ${said(side, pixel)}`).join("; ")}` : at;
    };
    const ask = async () => {
      if (asked) return;
      asked = true;
      values = await load(Number(number), file);
      draw();
    };
    const go = (to) => { pixel = [between(to[0], 0, width - 1), between(to[1], 0, height - 1)]; draw(); };
    const pressed = (name, on) => buttons[name].setAttribute("aria-pressed", on);
    const actions = {
      blink: () => {
        clearInterval(blinking);
        blinking = blinking ? 0 : setInterval(() => { cut = cut ? 0 : 100; draw(); }, 500);
        cut = blinking ? 100 : Number(range.value);
        pressed("blink", blinking > 0);
        draw();
      },
      zoom: () => { zoomed = !zoomed; pressed("zoom", zoomed); draw(); },
      worst: () => { zoomed = true; pressed("zoom", true); go(worstPixel); },
    };

    // The picture's pixel under the pointer.
    const under = (event) => {
      const box = images[0].getBoundingClientRect();
      return [(event.clientX - box.left) / box.width * width, (event.clientY - box.top) / box.height * height].map(Math.floor);
    };
    stage.addEventListener("pointermove", (event) => { if (!zoomed || event.buttons) go(under(event)); });
    stage.addEventListener("pointerdown", (event) => go(under(event)));
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    stage.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in arrows)) return;
      const [x, y] = arrows[event.key], step = event.shiftKey ? 8 : 1;
      go([pixel[0] + step * x, pixel[1] + step * y]);
      event.preventDefault();
    });
    viewer.addEventListener("keydown", (event) => {
      const name = { b: "blink", z: "zoom", w: "worst" }[event.key];
      if (!name || event.ctrlKey || event.altKey || event.metaKey || event.target.matches("select")) return;
      actions[name]();
      event.preventDefault();
    });
    Object.entries(buttons).forEach(([name, button]) => button.addEventListener("click", actions[name]));
    range.addEventListener("input", () => { cut = Number(range.value); draw(); });
    selects.forEach((select) => select.addEventListener("change", draw));
    new IntersectionObserver((entries) => { if (entries.some((entry) => entry.isIntersecting)) ask(); }).observe(stage);
    stage.style.aspectRatio = `${width} / ${height}`;
    viewer.hidden = false;
    draw();
  };
  document.querySelectorAll(".viewer").forEach(start);

  // From one comparison to the next, and back.
  document.addEventListener("keydown", (event) => {
    const step = { n: 1, p: -1 }[event.key];
    if (!step || event.ctrlKey || event.altKey || event.metaKey || event.target.matches("select")) return;
    const stages = [...document.querySelectorAll(".stage")];
    const own = stages.findIndex((stage) => stage.closest("section").contains(document.activeElement));
    const next = stages[own < 0 ? 0 : between(own + step, 0, stages.length - 1)];
    if (!next) return;
    next.focus({ preventScroll: true });
    next.closest("section").scrollIntoView();
  });
})();
