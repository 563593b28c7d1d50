// In the head, before anything is painted: the reader's choice, else the system's.
(() => {
    "use strict";
    const root = document.documentElement;
    const system = window.matchMedia("(prefers-color-scheme: dark)");
    let chosen = null;
    try {
        chosen = window.localStorage.getItem("etendue-theme");
    } catch {
        // No storage for pages from a file: the system's choice then.
    }
    const apply = () => {
        root.dataset.theme = chosen === "dark" || chosen === "light" ? chosen : system.matches ? "dark" : "light";
        root.dispatchEvent(new CustomEvent("themechange"));
    };
    window.toggleEtendueTheme = () => {
        chosen = root.dataset.theme === "dark" ? "light" : "dark";
        try {
            window.localStorage.setItem("etendue-theme", chosen);
        } catch {
            // It lasts as long as the page.
        }
        apply();
    };
    system.addEventListener("change", apply);
    apply();
})();
