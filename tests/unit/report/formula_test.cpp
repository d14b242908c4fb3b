// Formulas of texts as MathML.
#include "report/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <utility>

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
using ::testing::Not;

// MathML of one formula. In the expectations x stands for invisible times and f for the application of a function.
std::string math(const std::string& formula) {
  std::string html = with_formulas("`" + formula + "`");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"<mo>&#x2062;</mo>", "x"},
                                 {"<mo rspace=\"0.17em\">&#x2062;</mo>", "x "},
                                 {"<mo>&#x2061;</mo>", "f"},
                                 {"<mo rspace=\"0.17em\">&#x2061;</mo>", "f "},
                                 {"<mo stretchy=\"false\">(</mo>", "("},
                                 {"<mo stretchy=\"false\">)</mo>", ")"}})
    for (std::size_t at = 0; (at = html.find(from, at)) != std::string::npos;) html.replace(at, from.size(), to);
  return html;
}

struct Set {
  const char *formula, *inside;  // of <math>
};

void PrintTo(const Set& s, std::ostream* out) { *out << s.formula; }

class FormulaOfACase : public ::testing::TestWithParam<Set> {};

TEST_P(FormulaOfACase, IsSet) {
  EXPECT_EQ(math(GetParam().formula), "<math>" + std::string(GetParam().inside) + "</math>");
}

const Set formulas[] = {
    {"u = F L/EA",
     "<mi>u</mi><mo>=</mo>"
     "<mfrac><mrow><mi>F</mi>x<mi>L</mi></mrow><mrow><mi>E</mi><mi>A</mi></mrow></mfrac>"},
    {"w = F L^3/(3 EI)",
     "<mi>w</mi><mo>=</mo><mfrac><mrow><mi>F</mi>x<msup><mi>L</mi><mn>3</mn></msup></mrow>"
     "<mrow><mn>3</mn>x<mrow><mi>E</mi><mi>I</mi></mrow></mrow></mfrac>"},
    {"F L/kGA", "<mfrac><mrow><mi>F</mi>x<mi>L</mi></mrow><mrow><mi>k</mi><mi>G</mi><mi>A</mi></mrow></mfrac>"},
    {"P = pi^2 EI/L^2",
     "<mi>P</mi><mo>=</mo><mfrac><mrow><msup><mi>π</mi><mn>2</mn></msup>x<mrow><mi>E</mi><mi>I</mi></mrow></mrow>"
     "<msup><mi>L</mi><mn>2</mn></msup></mfrac>"},
    {"E = E90/sin gamma",
     "<mi>E</mi><mo>=</mo><mfrac><msub><mi>E</mi><mn>90</mn></msub>"
     "<mrow><mi>sin</mi>f <mi>γ</mi></mrow></mfrac>"},
    {"M = -dE/dgamma",
     "<mi>M</mi><mo>=</mo><mo form=\"prefix\">−</mo><mfrac><mrow><mi>d</mi><mi>E</mi></mrow>"
     "<mrow><mi>d</mi><mi>γ</mi></mrow></mfrac>"},
    {"c = sqrt(EA/mu)",
     "<mi>c</mi><mo>=</mo><msqrt><mfrac><mrow><mi>E</mi><mi>A</mi></mrow><mi>μ</mi></mfrac></msqrt>"},
    {"lambda = sqrt(EA/(2 k'))",
     "<mi>λ</mi><mo>=</mo><msqrt><mfrac><mrow><mi>E</mi><mi>A</mi></mrow>"
     "<mrow><mn>2</mn>x<msup><mi>k</mi><mo>′</mo></msup></mrow></mfrac></msqrt>"},
    {"sqrt(L0² - (r psi)²)",
     "<msqrt><msubsup><mi>L</mi><mn>0</mn><mn>2</mn></msubsup><mo>−</mo>"
     "<msup><mrow>(<mi>r</mi>x<mi>ψ</mi>)</mrow><mn>2</mn></msup></msqrt>"},
    // The whole product on the left is the numerator; what follows after a space is a factor again.
    {"2 EI/a (pi A^2/2)^2",
     "<mfrac><mrow><mn>2</mn>x<mrow><mi>E</mi><mi>I</mi></mrow></mrow><mi>a</mi></mfrac>x"
     "<msup><mrow><mo>(</mo><mfrac><mrow><mi>π</mi>x<msup><mi>A</mi><mn>2</mn></msup></mrow><mn>2</mn></mfrac>"
     "<mo>)</mo></mrow><mn>2</mn></msup>"},
    {"U = F (sin a + sin b)",
     "<mi>U</mi><mo>=</mo><mi>F</mi>x<mrow>(<mrow><mi>sin</mi>f <mi>a</mi></mrow><mo>+</mo>"
     "<mrow><mi>sin</mi>f <mi>b</mi></mrow>)</mrow>"},
    {"c^4 = 9 EI w^2/|E|",
     "<msup><mi>c</mi><mn>4</mn></msup><mo>=</mo><mfrac>"
     "<mrow><mn>9</mn>x<mrow><mi>E</mi><mi>I</mi></mrow>x<msup><mi>w</mi><mn>2</mn></msup></mrow>"
     "<mrow><mo stretchy=\"false\">|</mo><mi>E</mi><mo stretchy=\"false\">|</mo></mrow></mfrac>"},
    {"(r/L)^(3/4)",
     "<msup><mrow><mo>(</mo><mfrac><mi>r</mi><mi>L</mi></mfrac><mo>)</mo></mrow>"
     "<mfrac><mn>3</mn><mn>4</mn></mfrac></msup>"},
    {"24 s sin^3(d/4)",
     "<mn>24</mn>x<mi>s</mi>x <mrow><msup><mi>sin</mi><mn>3</mn></msup>f"
     "<mrow><mo>(</mo><mfrac><mi>d</mi><mn>4</mn></mfrac><mo>)</mo></mrow></mrow>"},
    {"dt^2 K + 2 dt D",
     "<mrow><mi>d</mi><msup><mi>t</mi><mn>2</mn></msup></mrow>x <mi>K</mi><mo>+</mo>"
     "<mn>2</mn>x <mrow><mi>d</mi><mi>t</mi></mrow>x <mi>D</mi>"},
    {"EA sum y^2", "<mrow><mi>E</mi><mi>A</mi></mrow>x <mrow><mo>∑</mo><msup><mi>y</mi><mn>2</mn></msup></mrow>"},
    {"EI k' = -F cos(slope)",
     "<mrow><mi>E</mi><mi>I</mi></mrow>x<msup><mi>k</mi><mo>′</mo></msup><mo>=</mo><mo form=\"prefix\">−</mo>"
     "<mi>F</mi>x <mrow><mi>cos</mi>f<mrow>(<mi>slope</mi>)</mrow></mrow>"},
    {"U_long/E_c", "<mfrac><msub><mi>U</mi><mi>long</mi></msub><msub><mi>E</mi><mi>c</mi></msub></mfrac>"},
    {"dt < 2/w", "<mrow><mi>d</mi><mi>t</mi></mrow><mo>&lt;</mo><mfrac><mn>2</mn><mi>w</mi></mfrac>"},
    {"kT/2", "<mfrac><mrow><mi>k</mi><mi>T</mi></mrow><mn>2</mn></mfrac>"},
    {"r tau = 0.04", "<mi>r</mi>x<mi>τ</mi><mo>=</mo><mn>0.04</mn>"},
    {"a >= b, x <= 10^-6",
     "<mi>a</mi><mo>≥</mo><mi>b</mi><mo>,</mo><mi>x</mi><mo>≤</mo>"
     "<msup><mn>10</mn><mrow><mo form=\"prefix\">−</mo><mn>6</mn></mrow></msup>"},
    {"(a - b)/(c - d)",
     "<mfrac><mrow><mi>a</mi><mo>−</mo><mi>b</mi></mrow><mrow><mi>c</mi><mo>−</mo><mi>d</mi></mrow></mfrac>"},
    {"a/b/c", "<mfrac><mfrac><mi>a</mi><mi>b</mi></mfrac><mi>c</mi></mfrac>"},
    {"2 3", "<mn>2</mn><mo>·</mo><mn>3</mn>"},
    {"ρ²θ", "<msup><mi>ρ</mi><mn>2</mn></msup>x<mi>θ</mi>"},
};

INSTANTIATE_TEST_SUITE_P(Cases, FormulaOfACase, ::testing::ValuesIn(formulas));

TEST(Formulas, LinesMayBreakALongOneBetweenItsTerms) {
  EXPECT_EQ(math("w = F L^3/(3 EI) + F L/kGA"),
            "<math><mi>w</mi></math><wbr/><math><mo>=</mo><mfrac><mrow><mi>F</mi>x<msup><mi>L</mi><mn>3</mn></msup>"
            "</mrow><mrow><mn>3</mn>x<mrow><mi>E</mi><mi>I</mi></mrow></mrow></mfrac></math><wbr/>"
            "<math><mo form=\"infix\">+</mo><mfrac><mrow><mi>F</mi>x<mi>L</mi></mrow>"
            "<mrow><mi>k</mi><mi>G</mi><mi>A</mi></mrow></mfrac></math>");
}

TEST(Formulas, TextOutsideIsEscaped) {
  EXPECT_EQ(with_formulas("if <b> & \"c\" then `x` 'y'"),
            "if &lt;b&gt; &amp; &quot;c&quot; then <math><mi>x</mi></math> &#39;y&#39;");
  EXPECT_EQ(with_formulas(""), "");
  EXPECT_EQ(with_formulas("u = F L/EA"), "u = F L/EA");
}

TEST(Formulas, BackquotesWithoutAFormulaStay) {
  EXPECT_EQ(with_formulas("an open `one & <more>"), "an open `one &amp; &lt;more&gt;");
  EXPECT_EQ(with_formulas("`"), "`");
  EXPECT_EQ(with_formulas("nothing `` here"), "nothing `` here");
  EXPECT_EQ(with_formulas("`x` and `"), "<math><mi>x</mi></math> and `");
}

TEST(Formulas, WhatCannotBeReadIsCode) {
  for (const char* text : {"auto",
                           "ropewalk validate run",
                           "run.max_steps",
                           "a +",
                           "+ a",
                           "a + - b",
                           "/a",
                           "a/",
                           "(a",
                           "a)",
                           "()",
                           "|a",
                           "x^",
                           "x^2^2",
                           "x_",
                           "sqrt",
                           "sqrt x",
                           "sin",
                           "²",
                           "--out",
                           "a $ b",
                           " "})
    EXPECT_EQ(with_formulas("`" + std::string(text) + "`"), "<code>" + std::string(text) + "</code>");
  EXPECT_EQ(with_formulas("`<script>alert(1)</script>`"), "<code>&lt;script&gt;alert(1)&lt;/script&gt;</code>");
  EXPECT_EQ(with_formulas("`x & y`"), "<code>x &amp; y</code>");
}

// No character of a formula reaches the page as markup.
TEST(Formulas, HostileTextMakesNoElement) {
  for (const char* text :
       {"`a<script>b`", "`a <img/b> c`", "`<script>`", "<script>`x`</script>", "`x_<b>`", "`<b`>`"})
    EXPECT_THAT(with_formulas(text),
                AllOf(Not(HasSubstr("<script")), Not(HasSubstr("<img")), Not(HasSubstr("<b"))));
}

TEST(Formulas, DepthIsLimited) {
  const auto repeated = [](const char* part) {
    std::string text;
    for (int k = 0; k < 10000; ++k) text += part;
    return text;
  };
  for (const char* part : {"(", "sqrt(", "sin ", "x^(", "|", "x/(", "x_(", "x/", "sum "}) {
    const std::string text = repeated(part);
    EXPECT_EQ(with_formulas("`" + text + "x`"), "<code>" + text + "x</code>") << part;
  }
  EXPECT_THAT(with_formulas("`" + repeated("(") + "x" + repeated(")") + "`"), HasSubstr("<code>((("));
  EXPECT_THAT(with_formulas("`((((((((x))))))))`"), HasSubstr("<math>"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
