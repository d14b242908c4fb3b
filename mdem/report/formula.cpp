#include "report/formula.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "io/markup.hpp"

namespace ropewalk {
namespace {

constexpr int deepest = 60;           // terms, factors and fractions in one another
constexpr std::size_t one_line = 24;  // characters of a formula that is not broken

struct NotAFormula {};

using Symbol = std::pair<std::string_view, std::string_view>;  // as it is written, and as it is shown
constexpr Symbol greek[] = {{"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},  {"epsilon", "ε"},
                            {"zeta", "ζ"},  {"eta", "η"},   {"theta", "θ"}, {"kappa", "κ"},  {"lambda", "λ"},
                            {"mu", "μ"},    {"nu", "ν"},    {"pi", "π"},    {"rho", "ρ"},    {"sigma", "σ"},
                            {"tau", "τ"},   {"phi", "φ"},   {"chi", "χ"},   {"psi", "ψ"},    {"omega", "ω"},
                            {"Gamma", "Γ"}, {"Delta", "Δ"}, {"Theta", "Θ"}, {"Lambda", "Λ"}, {"Phi", "Φ"},
                            {"Psi", "Ψ"},   {"Omega", "Ω"}};
constexpr Symbol raised[] = {{"'", "<mo>′</mo>"}, {"²", "<mn>2</mn>"}, {"³", "<mn>3</mn>"}, {"⁴", "<mn>4</mn>"}};
// A term may have a sign after these, but not after those that add.
constexpr Symbol relations[] = {{"<=", "≤"}, {">=", "≥"}, {"<", "&lt;"}, {">", "&gt;"}, {"=", "="}};
constexpr Symbol commas[] = {{",", ","}, {";", ";"}};
constexpr Symbol adding[] = {{"+", "+"}, {"-", "−"}};
constexpr std::string_view functions[] = {"sin",  "cos", "tan", "arctan", "sinh", "cosh", "tanh",
                                          "coth", "exp", "log", "ln",     "max",  "min"};
constexpr std::string_view stiffnesses[] = {"EA", "EI", "GJ", "kGA"};

template <class Table>
bool has(const Table& table, std::string_view name) {
  return std::find(std::begin(table), std::end(table), name) != std::end(table);
}

std::string_view greek_letter(std::string_view name) {
  const auto* s =
      std::find_if(std::begin(greek), std::end(greek), [&](const Symbol& g) { return g.first == name; });
  return s == std::end(greek) ? "" : s->second;
}

// Neither a letter, nor a product of letters, nor a differential.
bool is_word(std::string_view name) {
  return name.size() > 2 && greek_letter(name).empty() && !has(stiffnesses, name) &&
         (name[0] != 'd' || greek_letter(name.substr(1)).empty());
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

std::string element(const char* tag, std::string_view inside) {
  return std::string("<") + tag + ">" + std::string(inside) + "</" + tag + ">";
}

// Elements side by side.
struct MathRow {
  std::string html;
  int elements = 0;

  void add(const std::string& one) { add(MathRow{one, 1}); }
  void add(const MathRow& row) {
    html += row.html;
    elements += row.elements;
  }
  std::string one() const { return elements == 1 ? html : element("mrow", html); }
};

MathRow joined(const std::vector<MathRow>& pieces) {
  MathRow row;
  for (const MathRow& piece : pieces) row.add(piece);
  return row;
}

// A factor of a product: one element.
struct Factor {
  std::string html;
  bool apart = false;  // a thin space stands on either side
  bool number = false;
  std::string bare = {};  // where it is nothing but a bracket, without it
};

MathRow product_of(const std::vector<Factor>& factors) {
  MathRow row;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const bool apart = k > 0 && (factors[k - 1].apart || factors[k].apart);
    if (k > 0)
      row.add(factors[k].number ? "<mo>·</mo>"
              : apart           ? "<mo rspace=\"0.17em\">&#x2062;</mo>"
                                : "<mo>&#x2062;</mo>");
    row.add(factors[k].html);
  }
  return row;
}

// A numerator or a denominator.
std::string without_bracket(const std::vector<Factor>& factors) {
  return factors.size() == 1 && !factors[0].bare.empty() ? factors[0].bare : product_of(factors).one();
}

class Formula {
 public:
  explicit Formula(std::string_view text) : text_(text), breaks_(text.size() > one_line) {}

  // Throws NotAFormula.
  std::string mathml() {
    std::vector<MathRow> pieces = sum(breaks_);
    if (at_ < text_.size() || only_words_) throw NotAFormula{};
    if (!breaks_) pieces = {joined(pieces)};
    std::string html;
    for (const MathRow& piece : pieces) html += (html.empty() ? "" : "<wbr/>") + element("math", piece.html);
    return html;
  }

 private:
  std::string_view text_;
  bool breaks_;
  std::size_t at_ = 0;
  int depth_ = 0;
  char closing_ = 0;  // ends the innermost bracket
  bool only_words_ = true;

  struct Deeper {
    int& depth;
    explicit Deeper(int& of) : depth(of) {
      if (++depth > deepest) throw NotAFormula{};
    }
    ~Deeper() { --depth; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
  };

  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  template <class Table>
  std::string_view take_one(const Table& table) {
    for (const Symbol& s : table)
      if (take(s.first)) return s.second;
    return {};
  }
  std::string_view take_all(bool (*is)(char)) {
    const std::size_t from = at_;
    while (at_ < text_.size() && is(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }
  void skip_spaces() {
    take_all([](char c) { return c == ' '; });
  }

  // Terms with what stands between them. `apart`: a line may begin with every piece.
  std::vector<MathRow> sum(bool apart) {
    const Deeper deeper(depth_);
    std::vector<MathRow> pieces(1);
    for (bool sign = true;;) {
      skip_spaces();
      if (sign && take("-")) pieces.back().add("<mo form=\"prefix\">−</mo>");
      pieces.back().add(product());
      const std::string_view comma = take_one(commas), relation = comma.empty() ? take_one(relations) : "";
      sign = !comma.empty() || !relation.empty();
      const std::string_view plus = sign ? "" : take_one(adding);
      if (!sign && plus.empty()) return pieces;
      if (comma.empty()) only_words_ = false;
      if (!comma.empty()) pieces.back().add(element("mo", comma));
      pieces.emplace_back();
      if (!relation.empty()) pieces.back().add(element("mo", relation));
      // The first of a piece would be the sign of its term.
      if (!plus.empty()) pieces.back().add((apart ? "<mo form=\"infix\">" : "<mo>") + std::string(plus) + "</mo>");
    }
  }

  MathRow product() {
    std::vector<Factor> factors;
    for (int fractions = 0;;) {
      skip_spaces();
      if (factor_begins()) {
        factors.push_back(factor());
      } else if (factors.empty()) {
        throw NotAFormula{};
      } else if (take("/")) {
        if (++fractions > deepest) throw NotAFormula{};
        skip_spaces();
        factors = {Factor{element("mfrac", without_bracket(factors) + without_bracket(up_to_a_space()))}};
      } else {
        return product_of(factors);
      }
    }
  }

  std::vector<Factor> up_to_a_space() {
    std::vector<Factor> factors = {factor()};
    while (factor_begins()) factors.push_back(factor());
    return factors;
  }

  bool factor_begins() const {
    const char c = here();
    return c == '|' ? closing_ != '|' : is_digit(c) || is_letter(c) || c == '(' || !is_ascii(c);
  }

  Factor factor() {
    const Deeper deeper(depth_);
    const char c = here();
    if (is_letter(c)) return word();
    if (c == '(') return bracket(')');
    if (c == '|') return bracket('|');
    return {with_scripts(number_or_letter()), false, is_digit(c)};
  }

  MathRow inside(char closing) {
    ++at_;
    const char outer = std::exchange(closing_, closing);
    const MathRow row = joined(sum(false));
    if (!take({&closing, 1})) throw NotAFormula{};
    closing_ = outer;
    return row;
  }

  Factor bracket(char closing) {
    const std::string opening(1, here());
    const MathRow row = inside(closing);
    // Brackets that grow stand farther off: only around fractions.
    const std::string mo = row.html.find("<mfrac>") == std::string::npos ? "<mo stretchy=\"false\">" : "<mo>";
    const std::string whole = element("mrow", mo + opening + "</mo>" + row.html + mo + closing + "</mo>");
    Factor f{with_scripts(whole)};
    if (closing == ')' && f.html == whole) f.bare = row.one();
    return f;
  }

  Factor word() {
    const std::string_view name = take_all(is_letter);
    if (name == "sqrt") {
      if (here() != '(') throw NotAFormula{};
      return {with_scripts(element("msqrt", inside(')').html))};
    }
    const bool sum = name == "sum";
    if (!sum && !has(functions, name)) {
      MathRow row = letters(name, true);
      return {row.one(), is_word(name) || (row.elements == 2 && name[0] == 'd')};
    }
    only_words_ = false;
    MathRow call;
    call.add(sum ? with_scripts("<mo>∑</mo>") : with_scripts(element("mi", name)));
    skip_spaces();
    const bool bracketed = here() == '(';
    if (!sum) call.add(bracketed ? "<mo>&#x2061;</mo>" : "<mo rspace=\"0.17em\">&#x2061;</mo>");
    call.add(bracketed ? factor().html : product_of(up_to_a_space()).one());
    return {call.one(), true};
  }

  // Those of a product, of which the last may have scripts; or a word.
  MathRow letters(std::string_view name, bool scripts) {
    MathRow row;
    std::string last = element("mi", name);
    if (!is_word(name)) {
      only_words_ = false;
      for (; name.size() > 1 && greek_letter(name).empty(); name.remove_prefix(1))
        row.add(element("mi", name.substr(0, 1)));
      last = element("mi", name.size() > 1 ? greek_letter(name) : name);
    }
    row.add(scripts ? with_scripts(last, true) : last);
    return row;
  }

  // A number, or one letter or sign beyond ASCII.
  std::string number_or_letter() {
    only_words_ = false;
    const std::size_t from = at_;
    if (is_digit(here())) {
      take_all(is_digit);
      if (here() == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1])) {
        ++at_;
        take_all(is_digit);
      }
      return element("mn", text_.substr(from, at_ - from));
    }
    if (is_ascii(here()) || !take_one(raised).empty()) throw NotAFormula{};
    ++at_;
    take_all([](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; });  // the rest of its UTF-8
    return element("mi", text_.substr(from, at_ - from));
  }

  // `letter`: digits that follow are an index.
  std::string with_scripts(const std::string& base, bool letter = false) {
    std::string below, above;
    if (letter && is_digit(here())) below = element("mn", take_all(is_digit));
    for (bool more = true; more;) {
      if (below.empty() && take("_"))
        below = script();
      else if (above.empty() && take("^"))
        above = script();
      else
        more = above.empty() && !(above = take_one(raised)).empty();
    }
    if (above.empty()) return below.empty() ? base : element("msub", base + below);
    return below.empty() ? element("msup", base + above) : element("msubsup", base + below + above);
  }

  std::string script() {
    MathRow row;
    if (take("-")) row.add("<mo form=\"prefix\">−</mo>");
    if (here() == '(')
      row.add(inside(')'));
    else if (is_letter(here()))
      row.add(letters(take_all(is_letter), false));
    else
      row.add(number_or_letter());
    return row.one();
  }
};

}  // namespace

std::string with_formulas(const std::string& text) {
  std::string html;
  for (std::size_t at = 0;;) {
    const std::size_t open = text.find('`', at);
    const std::size_t close = open == std::string::npos ? open : text.find('`', open + 1);
    if (close == std::string::npos) return html + escape_markup(std::string_view(text).substr(at));
    const std::string piece = text.substr(open + 1, close - open - 1);
    html += escape_markup(std::string_view(text).substr(at, open - at));
    at = close + 1;
    try {
      html += piece.empty() ? "``" : Formula(piece).mathml();
    } catch (const NotAFormula&) {
      html += element("code", escape_markup(piece));
    }
  }
}

}  // namespace ropewalk
