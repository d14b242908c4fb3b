#include "io/toml_text.hpp"

#include <fmt/format.h>

#include <string_view>

#include "io/plain_text.hpp"

namespace ropewalk {
namespace {

// Reads no more of TOML than where strings and comments end, and where keys have dots.
class BoundsOfText {
 public:
  BoundsOfText(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void check() {
    if (text_.size() > longest_toml)
      refuse(fmt::format("has {} bytes", text_.size()), fmt::format("at most {} MiB are read", longest_toml >> 20));
    while (at_ < text_.size()) step();
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const {
    throw InputError({file_, text_.size() > longest_toml ? 0 : line_, ""}, what, remedy);
  }

  void step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') return skip_string(c);
    ++at_;
    switch (c) {
      case '\n':
        ++line_;
        dots_ = 0;
        line_is_new_ = true;
        return;
      case ' ':
      case '\t':
        return;
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        return;
      case '.':
        if (++dots_ >= most_key_parts)
          refuse(fmt::format("has a key of more than {} parts", most_key_parts),
                 "write fewer tables in one another");
        break;
      case '[':
      case '{':
        if (++depth_ > deepest_toml)
          refuse(fmt::format("has more than {} brackets in one another", deepest_toml),
                 "write fewer arrays and tables in one another");
        if (line_is_new_ || c == '{') count();
        dots_ = 0;
        break;
      case ']':
      case '}':
        --depth_;
        dots_ = 0;
        break;
      case '=':
        count();
        dots_ = 0;
        break;
      case ',':
        dots_ = 0;
        break;
      default:
        break;
    }
    line_is_new_ = false;
  }

  void count() {
    if (++keys_ > most_toml_keys)
      refuse(fmt::format("has more than {} keys and tables", most_toml_keys), "take fewer");
  }

  void skip_string(char quote) {
    const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
    const bool long_one = text_.substr(at_, 3) == three;
    at_ += long_one ? 3 : 1;
    line_is_new_ = false;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\\' && quote == '"') {
        ++at_;
        if (at_ < text_.size() && text_[at_] == '\n') ++line_;
        continue;
      }
      if (c == '\n' && !long_one) return;  // the parser complains
      if (c == '\n') ++line_;
      if (long_one ? text_.substr(at_, 3) == three : c == quote) {
        at_ += long_one ? 3 : 1;
        return;
      }
    }
    at_ = text_.size();
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1, dots_ = 0, depth_ = 0, keys_ = 0;
  bool line_is_new_ = true;
};

}  // namespace

toml::table parsed_toml(const std::string& text, const std::string& file) {
  BoundsOfText(text, file).check();
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    throw TomlError({file, static_cast<int>(e.source().begin.line), ""}, printable(std::string(e.description())),
                    fmt::format("mend the line near column {}", e.source().begin.column));
  }
}

}  // namespace ropewalk
