// The current parameters with their standard deviations, and the truth beside them.

import type { Parameter, Report } from "./api.js";
import { element } from "./canvas.js";

interface Row {
  measured: HTMLElement;
  sigma: HTMLElement;
  truth: HTMLElement;
  error: HTMLElement;
}

const NONE = "–";

export class ParameterPanel {
  private readonly body = element("#parameters tbody");
  private readonly facts = element("#facts");
  private readonly rows = new Map<string, Row>();
  private names = "";
  private said = "";

  show(report: Report): void {
    const names = report.parameters.map((parameter) => parameter.name).join();
    if (names !== this.names) {
      this.build(report.parameters);
      this.names = names;
    }
    for (const parameter of report.parameters) {
      this.fill(parameter);
    }
    const said = JSON.stringify(report.facts);
    if (said === this.said) {
      return;
    }
    this.said = said;
    this.facts.replaceChildren(
      ...report.facts.flatMap(({ label, value }) => {
        const [term, detail] = [document.createElement("dt"), document.createElement("dd")];
        term.textContent = label;
        detail.textContent = value;
        return [term, detail];
      }),
    );
  }

  private build(parameters: Parameter[]): void {
    this.body.replaceChildren();
    this.rows.clear();
    let section = "";
    for (const { name, label, unit, section: own } of parameters) {
      if (own !== section) {
        const cell = document.createElement("td");
        cell.colSpan = 6;
        cell.textContent = own;
        const row = document.createElement("tr");
        row.className = "section";
        row.append(cell);
        this.body.append(row);
        section = own;
      }
      const cell = (kind: string, text = "") => {
        const made = document.createElement("td");
        made.className = `${kind} number`;
        made.textContent = text;
        return made;
      };
      const made = { measured: cell("measured"), sigma: cell("sigma"), truth: cell("truth"), error: cell("error") };
      const row = document.createElement("tr");
      row.dataset["name"] = name;
      const title = document.createElement("td");
      title.textContent = label;
      title.title = name;
      row.append(title, made.measured, made.sigma, made.truth, made.error, cell("unit", unit));
      this.body.append(row);
      this.rows.set(name, made);
    }
  }

  private fill({ name, decimals, measured, sigma, truth }: Parameter): void {
    const row = this.rows.get(name);
    if (!row) {
      return;
    }
    const text = (value: number | null, digits: number) => (value === null ? NONE : value.toFixed(digits));
    const set = (cell: HTMLElement, value: number | null, digits: number) => {
      cell.textContent = text(value, digits);
      // The unrounded number, for tests and scripts.
      cell.dataset["value"] = value === null ? "" : String(value);
    };
    set(row.measured, measured, decimals);
    set(row.sigma, sigma, decimals + 1);
    set(row.truth, truth, decimals);
    const error = measured === null || truth === null ? null : measured - truth;
    set(row.error, error, decimals);
    row.error.classList.toggle("far", error !== null && sigma !== null && Math.abs(error) > 3 * sigma);
  }
}
