// Returns the texts whose contrast with their background is below WCAG's limit, with their contrast.
(() => {
  const channels = (text) => {
    const numbers = text.match(/[\d.e-]+/g).map(Number), scale = text.startsWith("color(") ? 1 : 255;
    return [...numbers.slice(0, 3).map((n) => n / scale), numbers.length > 3 ? numbers[3] : 1];
  };
  const light = (c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
  const behind = (element) => {
    for (let e = element; e; e = e.parentElement) {
      const colour = channels(getComputedStyle(e).backgroundColor);
      if (colour[3] > 0) return colour;
    }
  };
  const own = (element) => [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
  const seen = [...document.querySelectorAll("body *")].filter((e) => own(e) && e.checkVisibility() && !e.closest("script, option"));
  return seen.flatMap((element) => {
    const svg = element.closest("svg");
    // Of the figures, check only scatter plots: the background of a text on a bar is the bar.
    if (svg && !element.closest(".scatter")) return [];
    const style = getComputedStyle(element);
    const [a, b] = [channels(svg ? style.fill : style.color), behind(svg ? svg.parentElement : element)].map(luminance);
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    return contrast < 4.5 ? [`${element.textContent.trim().slice(0, 40)}: ${contrast}`] : [];
  });
})()
