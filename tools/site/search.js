// Search in the sections of all pages (words.js), without a server: all words must occur; titles count more than text.
(() => {
  const menu = document.querySelector(".wy-side-nav-search");
  const box = document.createElement("input");
  const list = document.createElement("div");
  box.type = "search";
  box.placeholder = "Search";
  box.setAttribute("aria-label", "Search the documentation");
  list.className = "found";
  menu.append(box, list);

  const score = (section, words) => {
    const title = section.title.toLowerCase();
    const text = section.text.toLowerCase();
    let sum = 0;
    for (const word of words) {
      const hits = (title.includes(word) ? 20 / section.level : 0) + Math.min(5, text.split(word).length - 1);
      if (hits === 0) return 0;
      sum += hits;
    }
    return sum;
  };

  const shown = (section, word) => {
    const link = document.createElement("a");
    link.href = base_url + "/" + section.at;
    const where = document.createElement("b");
    where.textContent = section.title === section.page ? section.title : section.page + " — " + section.title;
    const at = Math.max(0, section.text.toLowerCase().indexOf(word) - 40);
    const words = document.createElement("span");
    words.textContent = section.text.slice(at, at + 120);
    link.append(where, words);
    return link;
  };

  box.addEventListener("input", () => {
    const words = box.value.toLowerCase().split(/\s+/).filter((word) => word.length > 1);
    list.replaceChildren();
    if (words.length === 0) return;
    const best = window.talus_sections
      .map((section) => ({section, points: score(section, words)}))
      .filter((entry) => entry.points > 0)
      .sort((a, b) => b.points - a.points)
      .slice(0, 12);
    if (best.length === 0) list.textContent = "Nothing found.";
    for (const entry of best) list.append(shown(entry.section, words[0]));
  });
})();
