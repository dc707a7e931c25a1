"use strict";
// Speed against memory or time of the build: any scene and kind of rays, and what is done first with so many rays.
(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const figures = (x) => x >= 1000 ? Math.round(x).toLocaleString("en") : String(Number(x.toPrecision(3)));
  const scaled = (x, steps, units) => {
    const step = steps.findLastIndex((least) => x >= least);
    return `${figures(x / steps[Math.max(step, 0)])} ${units[Math.max(step, 0)]}`;
  };
  const bytes = (x) => scaled(x, [1, 1024, 1048576, 1073741824], ["B", "KiB", "MiB", "GiB"]);
  const duration = (ns) => scaled(ns, [1, 1e3, 1e6, 1e9], ["ns", "us", "ms", "s"]);
  const rays = (n) => n < 1e3 ? figures(n) : scaled(n, [1e3, 1e6, 1e9], ["thousand", "million", "thousand million"]);
  const draw = (parent, name, attributes, text) => {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    return parent.appendChild(element);
  };
  // Round numbers on a logarithmic axis, as many as have room.
  const ticks = ([low, high], room) => {
    const all = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++) all.push(...[1, 2, 5].map((f) => f * 10 ** e));
    const seen = all.filter((tick) => tick >= low && tick <= high);
    const tens = seen.filter((tick) => Math.abs(Math.log10(tick) - Math.round(Math.log10(tick))) < 1e-9);
    return seen.length <= room || tens.length < 2 ? seen : tens.filter((_, i) => i % Math.ceil(tens.length / room) === 0);
  };
  const costs = {
    bytes: { title: "memory of the finished structure", words: bytes, unit: (high) => high > 2e6 ? [1048576, "MiB"] : [1024, "KiB"] },
    build: { title: "build time", words: duration, unit: (high) => high > 2e9 ? [1e9, "s"] : [1e6, "ms"] },
  };

  for (const root of document.querySelectorAll(".scatter")) {
    const figure = root.closest("figure"), data = JSON.parse(figure.querySelector("script").textContent);
    const [scene, kind, cost] = ["scene", "rays", "cost"].map((part) => root.querySelector(`[data-part=${part}]`));
    const [plot, range, count, result, order] = [".plot", "input", ".count", ".result", ".order"].map((part) => root.querySelector(part));
    const fill = (select, names) => {
      const before = select.value;
      select.replaceChildren(...names.map((name) => new Option(name, name)));
      if (names.includes(before)) select.value = before;
    };
    const distinct = (names) => [...new Set(names)];

    const show = () => {
      const { points } = data.find((one) => one.scene === scene.value && one.rays === kind.value);
      const by = cost.value, axis = costs[by], n = 10 ** (range.value / 10);
      const total = (point) => point.build + n * point.ray;
      const first = points.reduce((a, b) => total(b) < total(a) ? b : a);
      const speed = (point) => 1e3 / point.ray;

      const width = Math.max(plot.clientWidth, 280), height = Math.min(Math.max(0.62 * width, 320), 430);
      const frame = { left: 46, right: width - 12, top: 26, bottom: height - 40 };
      const span = (values, room) => {
        const low = Math.min(...values), high = Math.max(...values), factor = Math.max(high / low, 2) ** room;
        return [low / factor, high * factor];
      };
      const xs = span(points.map((p) => p[by]), 0.12), ys = span(points.map(speed), 0.14);
      const share = (value, [low, high]) => Math.log(value / low) / Math.log(high / low);
      const x = (value) => frame.left + share(value, xs) * (frame.right - frame.left);
      const y = (value) => frame.bottom - share(value, ys) * (frame.bottom - frame.top);

      const svg = document.createElementNS(SVG, "svg");
      for (const [key, value] of [["viewBox", `0 0 ${width} ${height}`], ["role", "group"], ["aria-label", `Speed against ${axis.title}`]]) svg.setAttribute(key, value);
      const [unit, unitName] = axis.unit(xs[1]);
      for (const tick of ticks(ys, 8)) {
        draw(svg, "line", { class: "grid", x1: frame.left, x2: frame.right, y1: y(tick), y2: y(tick) });
        draw(svg, "text", { x: frame.left - 6, y: y(tick) + 4, "text-anchor": "end" }, figures(tick));
      }
      for (const tick of ticks(xs.map((v) => v / unit), width / 70)) {
        draw(svg, "line", { class: "grid", x1: x(tick * unit), x2: x(tick * unit), y1: frame.top, y2: frame.bottom });
        draw(svg, "text", { x: x(tick * unit), y: frame.bottom + 16, "text-anchor": "middle" }, figures(tick));
      }
      draw(svg, "text", { x: 2, y: 14 }, "million rays per second");
      draw(svg, "text", { x: frame.right, y: height - 6, "text-anchor": "end" }, `${axis.title}, ${unitName}`);

      // What nothing beats in both.
      const front = points.filter((p) => !points.some((o) => o !== p && o[by] <= p[by] && o.ray <= p.ray && (o[by] < p[by] || o.ray < p.ray)));
      front.sort((a, b) => a[by] - b[by]);
      const stair = front.flatMap((p, i) => [[x(p[by]), i ? y(speed(front[i - 1])) : frame.bottom], [x(p[by]), y(speed(p))]]);
      stair.push([frame.right, stair.at(-1)[1]]);
      const lines = [];
      const join = (places, name) => {
        draw(svg, "polyline", { class: name, points: places.map((place) => place.join(",")).join(" ") });
        const box = ([ax, ay], [bx, by]) => ({ left: Math.min(ax, bx) - 1, right: Math.max(ax, bx) + 1, top: Math.min(ay, by) - 1, bottom: Math.max(ay, by) + 1 });
        places.slice(1).forEach((place, i) => lines.push(box(places[i], place)));
      };
      join(stair, "front");

      // What takes as long as the first, build included.
      if (by === "build") {
        const line = [];
        for (let i = 0; i <= 200; i++) {
          const build = xs[0] * (xs[1] / xs[0]) ** (i / 200), left = total(first) - build;
          if (left > 0) line.push([x(build), y(1e3 * n / left)]);
        }
        const within = line.filter((place) => place[1] >= frame.top && place[1] <= frame.bottom);
        join(within, "equal");
      }

      const taken = points.map((p) => ({ left: x(p[by]) - 6, right: x(p[by]) + 6, top: y(speed(p)) - 6, bottom: y(speed(p)) + 6 }));
      plot.replaceChildren(svg);
      for (const point of [...points].sort((a, b) => a.ray - b.ray)) {
        const [cx, cy] = [x(point[by]), y(speed(point))];
        const told = `${point.label}: ${figures(speed(point))} million rays per second${point.ratio ? `, ${point.ratio}` : ""}; ${bytes(point.bytes)}; built in ${duration(point.build)}`;
        const group = draw(svg, "g", { tabindex: 0, role: "img", "aria-label": told, class: by === "build" && point === first ? "point first" : "point" });
        draw(group, "title", {}, told);
        draw(group, "circle", { cx, cy, r: 5, style: `fill: var(${point.colour})` });
        const text = draw(group, "text", { style: `fill: var(${point.colour})` }, point.label);
        const wide = text.getComputedTextLength();
        // The first place that is free: right, left, above, below.
        const places = [[cx + 9, cy + 4], [cx - 9 - wide, cy + 4], [cx - wide / 2, cy - 10], [cx - wide / 2, cy + 18], [cx + 9, cy - 10], [cx + 9, cy + 18], [cx - 9 - wide, cy - 10], [cx - 9 - wide, cy + 18]];
        const box = ([left, base]) => ({ left, right: left + wide, top: base - 11, bottom: base + 3 });
        const free = (b, others) => b.left > frame.left && b.right < width && b.top > 16 && b.bottom < frame.bottom
          && others.every((o) => b.right < o.left || b.left > o.right || b.bottom < o.top || b.top > o.bottom);
        // Beside the lines where there is room.
        const place = places.find((one) => free(box(one), [...taken, ...lines])) ?? places.find((one) => free(box(one), taken));
        if (!place) { text.remove(); continue; }
        text.setAttribute("x", place[0]);
        text.setAttribute("y", place[1]);
        taken.push(box(place));
      }

      count.textContent = `With ${rays(n)} rays:`;
      range.setAttribute("aria-valuetext", `${rays(n)} rays`);
      const after = points.filter((p) => p !== first).sort((a, b) => total(a) - total(b))[0];
      const times = after ? figures(total(after) / total(first)) : "";
      const next = after ? `; ${after.label} takes ${times === "1" ? "" : `${times} times `}as long` : "";
      result.textContent = `${first.label} finishes first, build included, after ${duration(total(first))}${next}.`;

      // Who is next to overtake, from no ray upward.
      let [now, from] = [points.reduce((a, b) => b.build < a.build ? b : a), 0];
      const done = [`${now.label} at once`];
      for (;;) {
        const at = (p) => (p.build - now.build) / (now.ray - p.ray);
        const faster = points.filter((p) => p.ray < now.ray);
        if (!faster.length) break;
        const overtakes = faster.reduce((a, b) => at(b) < at(a) ? b : a);
        from = Math.max(at(overtakes), from);
        now = overtakes;
        done.push(`${now.label} from ${rays(from)} rays`);
      }
      order.textContent = `Finished first, by number of rays: ${done.join(", ")}.`;
    };
    const kinds = () => fill(kind, data.filter((one) => one.scene === scene.value).map((one) => one.rays));
    fill(scene, distinct(data.map((one) => one.scene)));
    kinds();
    scene.addEventListener("change", () => { kinds(); show(); });
    [kind, cost].forEach((select) => select.addEventListener("change", show));
    range.addEventListener("input", show);
    figure.querySelector(".chart").hidden = true;
    root.hidden = false;
    let drawn = 0;
    new ResizeObserver(() => {
      if (plot.clientWidth !== drawn && plot.clientWidth > 0) { drawn = plot.clientWidth; show(); }
    }).observe(plot);
  }
})();
