// What keyboards and readers of screens need, and the theme has not: levels of headings, names of both margins, and
// the focus for what is wider than the page.
for (const caption of document.querySelectorAll("[role=heading]")) caption.ariaLevel = "2";
for (const [margin, name] of [[".sidebar-drawer", "All pages"], [".toc-drawer", "This page"]]) {
    document.querySelector(margin)?.setAttribute("aria-label", name);
}

function focusWide() {
    for (const block of document.querySelectorAll("pre, .table-wrapper, .formulas > div")) {
        if (block.scrollWidth > block.clientWidth) block.tabIndex = 0;
        else block.removeAttribute("tabindex");
    }
}

addEventListener("load", focusWide);
addEventListener("resize", focusWide);

// The page of a search has no heading of its own.
if (!document.querySelector("h1")) {
    const [title] = document.title.split(" - ");
    document.querySelector("article")?.prepend(Object.assign(document.createElement("h1"), { textContent: title }));
}

// The frame of the explorer is as high as its page, which says how high it is.
addEventListener("message", ({ data, source }) => {
    for (const frame of document.querySelectorAll("iframe")) {
        if (frame.contentWindow === source && data.explorer) frame.style.height = `${data.explorer}px`;
    }
});
