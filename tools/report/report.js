// Reads the embedded data and draws the sections that it has something for.

function showTheme() {
    byId("theme").textContent = document.documentElement.dataset.theme === "dark" ? "Light" : "Dark";
    byId("theme").setAttribute("aria-label", `Switch to ${byId("theme").textContent.toLowerCase()} colours`);
}

function drawContents() {
    const sections = [...document.querySelectorAll("main > section")].filter((section) => !section.hidden);
    byId("contents").replaceChildren(...sections.map((section) =>
        element("a", { href: `#${section.id}` }, section.querySelector(":scope > h2:not(.question)")?.textContent || "Answers")));
}

function drawReport() {
    const sourceText = byId("report-data").textContent.trim();
    const data = JSON.parse(sourceText);
    const model = buildModel(data);
    document.title = `${data.title || "Report"} – étendue bench`;
    byId("title").textContent = data.title || "Report";
    const draw = (id, drawInto) => {
        const section = byId(id);
        const drawn = drawInto(section);
        section.hidden = !drawn;
        return drawn;
    };
    draw("answer", (section) => { drawAnswers(model, section); return true; });
    draw("convergence", (section) => drawConvergence(model, section));
    draw("efficiency", (section) => drawEfficiency(model, section));
    const flipper = draw("pictures", (section) => drawPictures(model, section));
    draw("techniques", (section) => drawTechniques(model, section, flipper));
    draw("lenses", (section) => drawLenses(model, section));
    draw("data", (section) => drawData(model, section, sourceText));
    drawContents();
    byId("footer").textContent = "One file, nothing loaded from anywhere. Plots by d3 (BSD 3-clause).";
}

byId("theme").addEventListener("click", () => window.toggleEtendueTheme());
document.documentElement.addEventListener("themechange", showTheme);
showTheme();
try {
    drawReport();
} catch (error) {
    byId("failure").hidden = false;
    byId("failure").textContent = `This report cannot be drawn: ${error.message}`;
}
