"use strict";
// Draws every chart of the page, and again when the scheme of colours changes or the page is printed.
(() => {
  const charts = [...document.querySelectorAll(".plot")].map((place) => {
    const script = place.querySelector("script");
    const figure = JSON.parse(script.textContent);
    script.remove();
    return { place, figure };
  });
  const palette = ["#2f7fc1", "#e0752d", "#2f9e69", "#c9415a", "#8d6bc4", "#a0762f", "#3aa6b0", "#7c8792"];
  const template = (isDark) => {
    const ink = isDark ? "#d5dbe1" : "#2a3138";
    const line = isDark ? "#343d46" : "#dfe3e7";
    const axis = {
      gridcolor: line, zerolinecolor: isDark ? "#55606b" : "#b9c0c7", linecolor: line, ticks: "outside", tickcolor: line,
      automargin: true, title: { standoff: 8 },
      // The margin grows for a label at the end of an axis; without this the label is left out.
      ticklabeloverflow: "allow",
    };
    return {
      layout: {
        colorway: palette, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
        font: { color: ink, family: "system-ui, -apple-system, Segoe UI, sans-serif", size: 12 },
        // At the top is room for the buttons, which would lie over a chart without a legend.
        margin: { l: 64, r: 16, t: 28, b: 44 }, xaxis: axis, yaxis: axis,
        legend: { orientation: "h", itemsizing: "constant", y: 1.02, yanchor: "bottom", x: 0, bgcolor: "rgba(0,0,0,0)" },
        hoverlabel: { bgcolor: isDark ? "#1e242a" : "#ffffff", bordercolor: line, font: { color: ink } },
        hovermode: "closest", modebar: { bgcolor: "rgba(0,0,0,0)", color: isDark ? "#77828d" : "#a3abb3", activecolor: ink },
      },
    };
  };
  const config = {
    responsive: true, displaylogo: false, topojsonURL: "", showSendToCloud: false, plotlyServerURL: "",
    modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"],
  };
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const paper = matchMedia("print");
  const draw = () => {
    const isPrinted = paper.matches;
    for (const { place, figure } of charts) {
      const layout = { ...figure.layout, template: template(dark.matches && !isPrinted), autosize: true };
      // A sheet of A4 between its margins: the width of the screen is not that of the paper.
      if (isPrinted) Object.assign(layout, { autosize: false, width: 680, height: place.clientHeight });
      Plotly.react(place, structuredClone(figure.data), layout, config);
    }
  };
  draw();
  dark.addEventListener("change", draw);
  paper.addEventListener("change", draw);
})();
