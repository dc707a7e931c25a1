// Reports a page wider than the window, and columns of ratios that are visible only after scrolling.
(() => {
  const page = document.scrollingElement;
  const found = page.scrollWidth > innerWidth ? [`the page is ${page.scrollWidth} wide`] : [];
  if (innerWidth < 1400) return found;
  for (const head of document.querySelectorAll(".table th")) {
    const edge = head.closest(".scroll").getBoundingClientRect().right;
    const isRatio = head.textContent.startsWith("x ") && head.checkVisibility();
    if (isRatio && head.getBoundingClientRect().right > edge + 1) found.push(head.textContent);
  }
  return found;
})()
