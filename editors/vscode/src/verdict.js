// @ts-check
/** The verdict of a program, as the status bar shows it. */
"use strict";

/**
 * @typedef {object} Verdict
 * @property {string} uri
 * @property {number | null} version
 * @property {string} verdict pass, fail, unverified or not checked
 * @property {number} errors
 * @property {number} warnings
 * @property {number} notes
 * @property {number} sections
 * @property {string} machine
 * @property {string[]} reasons why it is not verified, or not checked
 */

/** The most reasons that a tooltip lists. */
const MOST_REASONS = 8;
const ICONS = new Map([
  ["pass", "$(pass)"],
  ["fail", "$(error)"],
  ["unverified", "$(question)"],
  ["not checked", "$(circle-slash)"],
]);

/**
 * @param {number} count
 * @param {string} what
 */
function counted(count, what) {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}

/**
 * The findings in words; empty without any.
 * @param {Verdict} verdict
 */
function findings({ errors, warnings, notes }) {
  return [[errors, "error"], [warnings, "warning"], [notes, "note"]]
    .filter(([count]) => count)
    .map(([count, what]) => counted(Number(count), String(what)))
    .join(", ");
}

/**
 * The text of the status bar. A text of the server is never an icon.
 * @param {Verdict | undefined} verdict undefined while the program is checked
 */
function text(verdict) {
  if (!verdict) {
    return "$(sync~spin) polarcheck";
  }
  const icon = verdict.verdict === "fail" && !verdict.errors ? "$(warning)" : ICONS.get(verdict.verdict) || "$(question)";
  const state = ICONS.has(verdict.verdict) ? verdict.verdict : "unknown verdict";
  const found = findings(verdict);
  return `${icon} ${state}${found ? `: ${found}` : ""}`;
}

/**
 * The lines of the tooltip; text from programs and settings, not markup.
 * @param {Verdict} verdict
 */
function details(verdict) {
  const found = findings(verdict) || (verdict.verdict === "not checked" ? "" : "no findings");
  const reasons = verdict.reasons.slice(0, MOST_REASONS);
  const more = verdict.reasons.length - reasons.length;
  return [
    `Verdict: ${verdict.verdict}`,
    ...(found ? [`Findings: ${found}`] : []),
    ...(verdict.verdict === "not checked" ? [] : [`Polar sections: ${verdict.sections}`]),
    ...(verdict.machine ? [`Machine: ${verdict.machine}`] : []),
    ...reasons.map((reason) => (verdict.verdict === "not checked" ? reason : `Not evaluated: ${reason}`)),
    ...(more > 0 ? [`and ${counted(more, "more reason")}`] : []),
  ];
}

module.exports = { details, text };
