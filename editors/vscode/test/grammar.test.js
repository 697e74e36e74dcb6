// @ts-check
/** The colors of programs: which scope each word has, that a line never colors the next one, and that no line takes long. */
"use strict";

const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { test } = require("node:test");
const oniguruma = require("vscode-oniguruma");
const { INITIAL, Registry, parseRawGrammar } = require("vscode-textmate");

const SYNTAXES = path.join(__dirname, "..", "syntaxes");
const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
const registry = new Registry({
  onigLib: oniguruma.loadWASM(wasm).then(() => ({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  })),
  loadGrammar: async (scope) => {
    const file = path.join(SYNTAXES, `${scope.replace("source.", "")}.tmLanguage.json`);
    return parseRawGrammar(fs.readFileSync(file, "utf8"), file);
  },
});

/**
 * The texts of some lines with the innermost scope of each, without the name of the language; blanks left out.
 * @param {string} language
 * @param {...string} lines
 */
async function scopes(language, ...lines) {
  const grammar = await registry.loadGrammar(`source.${language}`);
  assert(grammar);
  let stack = INITIAL;
  /** @type {string[]} */
  const found = [];
  for (const line of lines) {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    stack = ruleStack;
    for (const { startIndex, endIndex, scopes: of } of tokens) {
      const text = line.slice(startIndex, endIndex).trim();
      if (text) {
        found.push(`${text} ${(of.at(-1) ?? "").replace(`.${language}`, "")}`);
      }
    }
  }
  return found;
}

/** @type {[string, string, string[]][]} */
const BLOCKS = [
  ["gcode", "%", ["% keyword.control.tape"]],
  ["gcode", "O1234(SHAFT)", ["O1234 entity.name.function.program", "( comment.block.parentheses", "SHAFT comment.block.parentheses", ") comment.block.parentheses"]],
  ["gcode", ":77", [":77 entity.name.function.program"]],
  ["gcode", "N10G12.1", ["N10 entity.name.label", "G12.1 keyword.control.polar"]],
  ["gcode", "g112 ; on", ["g112 keyword.control.polar", "; on comment.line.semicolon"]],
  ["gcode", "G1X10.5C-.3F120", ["G1 keyword.control.g-code", "X variable.parameter.axis", "10.5 constant.numeric", "C variable.parameter.axis", "- keyword.operator", ".3 constant.numeric", "F variable.parameter.feed", "120 constant.numeric"]],
  ["gcode", "/2 M98 P77", ["/2 keyword.control.skip", "M98 support.function.m-code", "P variable.parameter.word", "77 constant.numeric"]],
  ["gcode", "T0808", ["T0808 entity.name.type.tool"]],
  ["gcode", "IF[#1EQ2]GOTO100", ["IF keyword.control.flow", "[ punctuation.section.brackets", "#1 variable.other", "EQ keyword.operator.word", "2 constant.numeric", "] punctuation.section.brackets", "GOTO keyword.control.flow", "100 entity.name.label"]],
  ["gcode", "WHILE[#[#2+1]LT SIN[30.]]DO1", ["WHILE keyword.control.flow", "[ punctuation.section.brackets", "# variable.other", "[ punctuation.section.brackets", "#2 variable.other", "+ keyword.operator", "1 constant.numeric", "] punctuation.section.brackets", "LT keyword.operator.word", "SIN support.function.math", "[ punctuation.section.brackets", "30. constant.numeric", "] punctuation.section.brackets", "] punctuation.section.brackets", "DO keyword.control.flow", "1 constant.numeric"]],
  ["gcode", "(POLARCHECK ALLOW RAPID-IN-POLAR, OVERCUT)", ["( comment.block.parentheses", "POLARCHECK keyword.control.directive", "ALLOW keyword.control.directive", "RAPID-IN-POLAR, OVERCUT entity.name.tag.rule", ") comment.block.parentheses"]],
  ["gcode", "G1,R5.", ["G1 keyword.control.g-code", ",R variable.parameter.word", "5. constant.numeric"]],
  ["gcode", "GOTO NLAP1", ["GOTO keyword.control.flow", "NLAP1 entity.name.label"]],
  ["gcode", "#101=#_OFS", ["#101 variable.other", "= keyword.operator", "#_OFS variable.language"]],
  ["sinumerik", "N30 TRANSMIT ; on", ["N30 entity.name.label", "TRANSMIT keyword.control.polar", "; comment.line.semicolon", "on comment.line.semicolon"]],
  ["sinumerik", "LOOP1: R1=R1+1", ["LOOP1: entity.name.label", "R1 variable.other", "= keyword.operator", "R1 variable.other", "+ keyword.operator", "1 constant.numeric"]],
  ["sinumerik", 'T="MILL_8" D1', ['T="MILL_8" entity.name.type.tool', "D1 entity.name.type.tool"]],
  ["sinumerik", "IF R1<>2 GOTOF ENDE", ["IF keyword.control.flow", "R1 variable.other", "<> keyword.operator", "2 constant.numeric", "GOTOF keyword.control.flow", "ENDE entity.name.label"]],
  ["sinumerik", "G1 X=IC(5) F100", ["G1 keyword.control.g-code", "X variable.parameter.axis", "= keyword.operator", "IC support.function.command", "( punctuation.section.brackets", "5 constant.numeric", ") punctuation.section.brackets", "F variable.parameter.feed", "100 constant.numeric"]],
  ["sinumerik", "G2 X10Y5 CR=2.5", ["G2 keyword.control.g-code", "X variable.parameter.axis", "10 constant.numeric", "Y variable.parameter.axis", "5 constant.numeric", "CR support.function.command", "= keyword.operator", "2.5 constant.numeric"]],
  ["sinumerik", "DEF REAL DEPTH=$P_UIFR[1,X,TR]", ["DEF keyword.control.flow", "REAL storage.type", "DEPTH variable.other", "= keyword.operator", "$P_UIFR variable.language", "[ punctuation.section.brackets", "1 constant.numeric", ",X, source", "TR variable.other", "] punctuation.section.brackets"]],
];

for (const [language, block, expected] of BLOCKS) {
  test(`${language}: ${block}`, async () => assert.deepStrictEqual(await scopes(language, block), expected));
}

for (const [language, first] of [["gcode", "G0 (a comment that is not closed"], ["sinumerik", 'MSG("not closed'], ["gcode", "#<name"]]) {
  test(`${language}: the line after ${first} is code`, async () => {
    assert.deepStrictEqual((await scopes(language, first, "G1 X5")).slice(-3), ["G1 keyword.control.g-code", "X variable.parameter.axis", "5 constant.numeric"]);
  });
}

test("nothing of another language is included, and no text of a program can end a comment elsewhere", () => {
  for (const file of fs.readdirSync(SYNTAXES)) {
    const text = fs.readFileSync(path.join(SYNTAXES, file), "utf8");
    assert(![...text.matchAll(/"include": "(.*)"/g)].some(([, target]) => !target.startsWith("#")), file);
    assert(!text.includes("injection"), file);
  }
});

test("a line of any characters is colored in time that grows with its length", async () => {
  const pieces = ["(", ")", "#", "#<", "N", "N ", "X ", "X\t\t\t\t\t\t\t\t\t", "-", "G", "G0", "G00", "O", ":", "%", "<", "<A", '"', "'", ";", "$", "_", "A", "A-", "R[", "IF[", " ", "1", "1.", ",", "T=", "(POLARCHECK ALLOW A-B,", "GOTO", "É", "\u{1F600}", "/"];
  for (const language of ["gcode", "sinumerik"]) {
    const grammar = await registry.loadGrammar(`source.${language}`);
    assert(grammar);
    for (const piece of pieces) {
      /** The best of three [ms]: other processes take their time, too. @param {number} length */
      const time = (length) => {
        const line = piece.repeat(Math.ceil(length / piece.length));
        const times = [1, 2, 3].map(() => {
          const begun = performance.now();
          grammar.tokenizeLine(line, INITIAL);
          return performance.now() - begun;
        });
        return Math.min(...times);
      };
      time(200);
      // 16 times the length: a square would take 256 times as long.
      const [short, long] = [time(100), time(1600)];
      assert(long < 200 || long < 80 * short, `${language}: ${JSON.stringify(piece)} ${short} ms, ${long} ms`);
    }
  }
});
