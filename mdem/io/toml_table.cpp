#include "io/toml_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "io/toml_text.hpp"

namespace ropewalk {
namespace {

std::string quoted(const std::string& text) { return "\"" + printable(text, 40) + "\""; }

// The value in the file, for messages "is ..., ... is needed".
std::string describe(const toml::node& node) {
  if (const auto* v = node.as_string()) return "the string " + quoted(v->get());
  if (const auto* v = node.as_integer()) return fmt::format("the integer {}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("the number {}", v->get());
  if (const auto* v = node.as_boolean()) return fmt::format("the boolean {}", v->get());
  if (const auto* v = node.as_array()) return fmt::format("an array of {}", v->size());
  return node.is_table() ? "a table" : "a date or time";
}

std::string list_of(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last : ", ";
    text += words[i];
  }
  return text;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Edit distance: insertions, deletions, replacements, and swaps of adjacent letters.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

// Whether two keys differ only in the unit: `length` or `length_A` for `length_nm`.
bool same_but_for_unit(const std::string& a, const std::string& b) {
  const auto starts = [](const std::string& text, const std::string& stem) {
    return !stem.empty() && text.compare(0, stem.size() + 1, stem + "_") == 0;
  };
  const auto without_unit = [](const std::string& text) {
    return text.substr(0, std::min(text.rfind('_'), text.size()));
  };
  return starts(b, a) || starts(a, b) || starts(b, without_unit(a)) || starts(a, without_unit(b));
}

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

void refuse_control_characters(const toml::node& node, const std::string& key, const std::string& file) {
  const auto refuse = [&](const toml::node& at, const std::string& where, const char* what) {
    throw InputError({file, line_of(at), printable(where)}, what,
                     "write it in one line, without tabs, newlines and escapes");
  };
  if (const auto* text = node.as_string(); text && has_control_character(text->get()))
    refuse(node, key, "holds a control character");
  if (const toml::array* array = node.as_array())
    for (const toml::node& element : *array) refuse_control_characters(element, key, file);
  if (const toml::table* table = node.as_table())
    for (const auto& [name, value] : *table) {
      const std::string path = (key.empty() ? "" : key + ".") + std::string(name.str());
      if (has_control_character(name.str())) refuse(value, path, "is a key with a control character");
      refuse_control_characters(value, path, file);
    }
}

}  // namespace

std::string toml_string(const std::string& text) { return nlohmann::json(text).dump(); }

std::string toml_key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  });
  return bare ? key : toml_string(key);
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  if (word.size() > 64) return "";
  const std::string w = lower(word);
  std::string best;
  std::size_t least = 1 + std::min<std::size_t>(3, 1 + w.size() / 4);
  for (const std::string& k : known) {
    std::size_t d = edit_distance(w, lower(k));
    if (d > 1 && same_but_for_unit(w, lower(k))) d = 1;
    if (d < least && 2 * d < std::max(w.size(), k.size())) {
      least = d;
      best = k;
    }
  }
  return best;
}

bool Bounds::allow(double value) const {
  return std::isfinite(value) && (open ? value > least : value >= least) && value <= most;
}

std::string Bounds::words() const {
  const bool below = std::isfinite(most);
  if (!std::isfinite(least)) return below ? fmt::format("must be at most {}", most) : "must be a finite number";
  if (open && least == 0) return below ? fmt::format("must be positive and at most {}", most) : "must be positive";
  if (open) return fmt::format("must be above {}", least) + (below ? fmt::format(" and at most {}", most) : "");
  if (below) return fmt::format("must lie between {} and {}", least, most);
  return least == 0 ? "must not be negative" : fmt::format("must be at least {}", least);
}

struct TomlTable::Node {
  std::string file;
  std::string path;
  bool listed = false;                      // one of several, [[path]]
  bool has_errors = false;                  // its numbers may have a standard error
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table = nullptr;       // none: the table is missing
  std::vector<std::string> keys;
  std::set<std::string> asked;
  std::vector<TomlTable> taken;

  Node(std::string f, std::string p, std::shared_ptr<const toml::table> r, const toml::table* t)
      : file(std::move(f)), path(std::move(p)), root(std::move(r)), table(t) {
    if (table)
      for (const auto& [key, value] : *table) keys.emplace_back(key.str());
  }

  std::string full(const std::string& key) const {
    return printable(path.empty() || key.empty() ? path + key : path + "." + key);
  }

  const toml::node* find(const std::string& key) {
    asked.insert(key);
    return table ? table->get(key) : nullptr;
  }

  const toml::node& required(const TomlTable& self, const std::string& key) {
    const toml::node* found = find(key);
    if (!found) throw missing(self, key);
    return *found;
  }

  // A misspelt key may be among the keys that have not been read yet.
  InputError missing(const TomlTable& self, const std::string& key) const {
    const std::string near = nearest_word(key, strays());
    if (!near.empty())
      return self.error(key, "is missing",
                        fmt::format("did you mean it by \"{}\" in line {}?", printable(near), self.line(near)));
    const std::string where = path.empty() ? "at the top, before the first table" : "below " + header();
    return self.error(key, "is missing", fmt::format("add {} = ... {}", key, where));
  }

  std::string header() const { return printable(listed ? "[[" + path + "]]" : "[" + path + "]"); }

  std::vector<std::string> strays() const {
    std::vector<std::string> out;
    for (const std::string& k : keys)
      if (!asked.count(k)) out.push_back(k);
    return out;
  }
};

struct TomlTable::Stray {
  const TomlTable* owner = nullptr;
  std::string key;
  int line = INT_MAX;
};

TomlTable TomlTable::parse(const std::string& text, const std::string& file) {
  const auto root = std::make_shared<const toml::table>(parsed_toml(text, file));
  refuse_control_characters(*root, "", file);
  return TomlTable(std::make_shared<Node>(file, "", root, root.get()));
}

bool TomlTable::has(const std::string& key) const { return node_->find(key) != nullptr; }

bool TomlTable::is_string(const std::string& key) const {
  const toml::node* n = node_->find(key);
  return n && n->is_string();
}

bool TomlTable::is_array(const std::string& key) const {
  const toml::node* n = node_->find(key);
  return n && n->is_array();
}

bool TomlTable::is_table(const std::string& key) const {
  const toml::node* n = node_->find(key);
  return n && n->is_table();
}

const std::vector<std::string>& TomlTable::keys() const { return node_->keys; }
const std::string& TomlTable::path() const { return node_->path; }

int TomlTable::line() const { return node_->table && !node_->path.empty() ? line_of(*node_->table) : 0; }

int TomlTable::line(const std::string& key) const {
  if (node_->table) {
    const auto at = node_->table->find(key);
    if (at != node_->table->cend()) return static_cast<int>(at->first.source().begin.line);
  }
  return line();
}

InputError TomlTable::error(const std::string& key, const std::string& what, const std::string& remedy) const {
  return InputError({node_->file, line(key), node_->full(key)}, what, remedy);
}

namespace {

constexpr double smallest_number = 1e-100;  // its square is above what a double holds as a normal number

[[noreturn]] void refuse_type(const TomlTable& t, const std::string& key, const toml::node& found,
                              const std::string& needed, const std::string& remedy) {
  throw t.error(key, fmt::format("is {}, {} is needed", describe(found), needed), remedy);
}

double checked_number(const TomlTable& t, const std::string& key, const toml::node& n, const Bounds& bounds) {
  if (!n.is_number())
    refuse_type(t, key, n, "a number", n.is_string() ? "write it without quotes" : "write a plain number");
  // Not n.value<double>(), which is empty for whole numbers that a double rounds.
  const double value = n.is_integer() ? static_cast<double>(n.as_integer()->get()) : n.as_floating_point()->get();
  if (value != 0 && std::fabs(value) < smallest_number)
    throw t.error(key, fmt::format("is {}, too small a number to be calculated with", value),
                  "write 0 if you mean none");
  if (!bounds.allow(value)) throw t.error(key, fmt::format("is {}", value), bounds.words());
  return value;
}

long checked_integer(const TomlTable& t, const std::string& key, const toml::node& n, long least, long most) {
  if (!n.is_integer())
    refuse_type(
        t, key, n, "an integer",
        n.is_floating_point() ? "write a whole number without a decimal point" : "write a plain whole number");
  const std::int64_t value = n.as_integer()->get();
  if (value < least || value > most)
    throw t.error(key, fmt::format("is {}", value), fmt::format("must lie between {} and {}", least, most));
  return static_cast<long>(value);
}

const toml::array& checked_array(const TomlTable& t, const std::string& key, const toml::node& n,
                                 const std::string& needed) {
  if (!n.is_array()) refuse_type(t, key, n, needed, "write it in [ ]");
  return *n.as_array();
}

}  // namespace

void TomlTable::allow_standard_errors() const { node_->has_errors = true; }

std::optional<double> TomlTable::standard_error(const std::string& key) const {
  if (!node_->has_errors || !is_table(key)) return std::nullopt;
  const TomlTable both = table(key);  // finish() asks whether all of one table was read
  both.number("value", Bounds::any());
  return both.number("standard_error", Bounds::non_negative());
}

double TomlTable::number(const std::string& key, const Bounds& bounds) const {
  if (node_->has_errors && is_table(key)) {
    const TomlTable both = table(key);
    both.number("standard_error", Bounds::non_negative());
    return both.number("value", bounds);
  }
  const toml::node& n = node_->required(*this, key);
  return checked_number(*this, key, n, bounds);
}

long TomlTable::integer(const std::string& key, long least, long most) const {
  const toml::node& n = node_->required(*this, key);
  return checked_integer(*this, key, n, least, most);
}

bool TomlTable::boolean(const std::string& key) const {
  const toml::node& n = node_->required(*this, key);
  if (!n.is_boolean()) refuse_type(*this, key, n, "a boolean", "write true or false, without quotes");
  return n.as_boolean()->get();
}

std::string TomlTable::text(const std::string& key) const {
  const toml::node& n = node_->required(*this, key);
  if (!n.is_string()) refuse_type(*this, key, n, "a string", "write it in quotes");
  return n.as_string()->get();
}

std::string TomlTable::string(const std::string& key) const {
  std::string value = text(key);
  if (value.empty()) throw error(key, "is empty", "give it a text or leave the key out");
  return value;
}

std::size_t TomlTable::word_index(const std::string& key, const std::vector<std::string>& words) const {
  const std::string text = string(key);
  const auto at = std::find(words.begin(), words.end(), text);
  if (at != words.end()) return static_cast<std::size_t>(at - words.begin());
  std::vector<std::string> in_quotes;
  for (const std::string& w : words) in_quotes.push_back(quoted(w));
  const std::string near = nearest_word(text, words);
  throw error(key, fmt::format("is {}", quoted(text)),
              near.empty() ? "choose " + list_of(in_quotes, " or ")
                           : fmt::format("did you mean {}? Choose {}", quoted(near), list_of(in_quotes, " or ")));
}

std::vector<double> TomlTable::numbers(const std::string& key, const Bounds& bounds, std::size_t size) const {
  const std::string needed = fmt::format("an array of {} numbers", size);
  const toml::node& n = node_->required(*this, key);
  const toml::array& array = checked_array(*this, key, n, needed);
  if (array.size() != size) refuse_type(*this, key, n, needed, "give one number for each component");
  std::vector<double> out;
  for (const toml::node& element : array) out.push_back(checked_number(*this, key, element, bounds));
  return out;
}

std::vector<double> TomlTable::list(const std::string& key, const Bounds& bounds) const {
  const toml::node& n = node_->required(*this, key);
  const toml::array& array = checked_array(*this, key, n, "an array of numbers");
  if (array.empty()) throw error(key, "is an empty array", "give it at least one number");
  std::vector<double> out;
  for (const toml::node& element : array) out.push_back(checked_number(*this, key, element, bounds));
  return out;
}

std::vector<std::vector<double>> TomlTable::rows(const std::string& key, const Bounds& bounds,
                                                 std::size_t columns) const {
  const std::string needed = fmt::format("a list of arrays of {} numbers", columns);
  const toml::node& n = node_->required(*this, key);
  const toml::array& array = checked_array(*this, key, n, needed);
  if (array.empty()) throw error(key, "is an empty array", "give it at least one row");
  std::vector<std::vector<double>> out;
  for (const toml::node& row : array) {
    if (!row.is_array() || row.as_array()->size() != columns)
      refuse_type(*this, key, row, needed, "write it like [[0, 0], [100, 1]]");
    out.emplace_back();
    for (const toml::node& element : *row.as_array())
      out.back().push_back(checked_number(*this, key, element, bounds));
  }
  return out;
}

std::vector<std::vector<double>> TomlTable::matrix(const std::string& key, const Bounds& bounds,
                                                   std::size_t size) const {
  const std::string needed = fmt::format("{} arrays of {} numbers each", size, size);
  const toml::node& n = node_->required(*this, key);
  const toml::array& rows = checked_array(*this, key, n, needed);
  const auto refuse = [&](const toml::node& node) {
    refuse_type(*this, key, node, needed, "give all rows and columns");
  };
  if (rows.size() != size) refuse(n);
  std::vector<std::vector<double>> out;
  for (const toml::node& row : rows) {
    if (!row.is_array() || row.as_array()->size() != size) refuse(row);
    out.emplace_back();
    for (const toml::node& element : *row.as_array())
      out.back().push_back(checked_number(*this, key, element, bounds));
  }
  return out;
}

std::vector<long> TomlTable::integers(const std::string& key, long least, long most) const {
  const toml::node& n = node_->required(*this, key);
  const toml::array& array = checked_array(*this, key, n, "an array of integers");
  if (array.empty()) throw error(key, "is an empty array", "name at least one");
  std::vector<long> out;
  for (const toml::node& element : array) out.push_back(checked_integer(*this, key, element, least, most));
  return out;
}

std::vector<std::string> TomlTable::strings(const std::string& key) const {
  const toml::node& n = node_->required(*this, key);
  const toml::array& array = checked_array(*this, key, n, "an array of strings");
  if (array.empty()) throw error(key, "is an empty array", "name at least one");
  std::vector<std::string> out;
  for (const toml::node& element : array) {
    const auto text = element.value<std::string>();
    if (!text || text->empty()) throw error(key, "holds what is not a text", "write \"...\" in quotes");
    out.push_back(*text);
  }
  return out;
}

double TomlTable::number_or(const std::string& key, double fallback, const Bounds& bounds) const {
  return has(key) ? number(key, bounds) : fallback;
}

long TomlTable::integer_or(const std::string& key, long fallback, long least, long most) const {
  return has(key) ? integer(key, least, most) : fallback;
}

bool TomlTable::boolean_or(const std::string& key, bool fallback) const {
  return has(key) ? boolean(key) : fallback;
}

std::string TomlTable::string_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? string(key) : fallback;
}

TomlTable TomlTable::table(const std::string& key, const std::string& form) const {
  const toml::node* n = node_->find(key);
  const std::string path = node_->path.empty() ? key : node_->path + "." + key;
  if (n && !n->is_table())
    refuse_type(
        *this, key, *n, "a table",
        form.empty() ? fmt::format("write [{}] above its keys", path) : fmt::format("write {} = {}", key, form));
  TomlTable out(std::make_shared<Node>(node_->file, path, node_->root, n ? n->as_table() : nullptr));
  node_->taken.push_back(out);
  return out;
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  const toml::node* n = node_->find(key);
  if (!n) return {};
  const std::string header = fmt::format("write [[{}]] above each of them", key);
  if (!n->is_array()) refuse_type(*this, key, *n, "a list of tables", header);
  const std::string path = node_->path.empty() ? key : node_->path + "." + key;
  std::vector<TomlTable> out;
  for (const toml::node& element : *n->as_array()) {
    if (!element.is_table()) refuse_type(*this, key, element, "a list of tables", header);
    out.push_back(TomlTable(std::make_shared<Node>(node_->file, path, node_->root, element.as_table())));
    out.back().node_->listed = true;
    node_->taken.push_back(out.back());
  }
  return out;
}

void TomlTable::find_stray(Stray& first) const {
  for (const std::string& key : node_->strays())
    if (line(key) < first.line) first = {this, key, line(key)};
  for (const TomlTable& t : node_->taken) t.find_stray(first);
}

void TomlTable::finish(const Elsewhere& elsewhere) const {
  Stray stray;
  find_stray(stray);
  if (!stray.owner) return;
  const Node& node = *stray.owner->node_;
  const toml::table* as_table = node.table->get_as<toml::table>(stray.key);
  const char* what = as_table && !as_table->is_inline() ? "unknown table" : "unknown key";
  const std::string remedy = elsewhere ? elsewhere(stray.key) : "";
  if (!remedy.empty()) throw stray.owner->error(stray.key, what, remedy);
  const std::vector<std::string> known(node.asked.begin(), node.asked.end());
  const std::string near = nearest_word(stray.key, known);
  if (!near.empty()) throw stray.owner->error(stray.key, what, fmt::format("did you mean \"{}\"?", near));
  throw stray.owner->error(stray.key, what, known.empty() ? "take it away" : "known here: " + list_of(known, ", "));
}

}  // namespace ropewalk
