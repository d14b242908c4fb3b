#include "io/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>

#include "model/error.hpp"

namespace ropewalk {
namespace {

unsigned byte_at(std::string_view text, std::size_t k) {
  return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
}

// C1 characters are two bytes of UTF-8, c2 80 to c2 9f.
std::size_t control_bytes(std::string_view text, std::size_t k) {
  const unsigned here = byte_at(text, k), next = byte_at(text, k + 1);
  if (here < 0x20 || here == 0x7f) return 1;
  return here == 0xc2 && next >= 0x80 && next < 0xa0 ? 2 : 0;
}

bool is_word_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::size_t indent_of(std::string_view line) { return std::min(line.find_first_not_of(' '), line.size()); }

// A list goes on behind its mark, other text below its first letter.
std::size_t hanging_indent(std::string_view line) {
  const std::size_t indent = indent_of(line);
  return indent + (line.substr(indent, 2) == "- " ? 2 : 0);
}

// Where the last column begins that two spaces part from what is before, such as the meaning of an option.
std::size_t last_column(std::string_view line) {
  std::size_t column = hanging_indent(line);
  for (std::size_t k = column + 2; k < std::min(line.size(), widest_line / 2); ++k)
    if (line[k] != ' ' && line[k - 1] == ' ' && line[k - 2] == ' ') column = k;
  return column;
}

std::string filled(const std::string& line, std::size_t indent) {
  if (columns_of(line) <= widest_line) return line + "\n";
  std::string text;
  for (const std::string& part : lines_of(std::string_view(line).substr(indent), widest_line - indent))
    text += (text.empty() ? line.substr(0, indent) : std::string(indent, ' ')) + part + "\n";
  return text;
}

}  // namespace

bool has_control_character(std::string_view text) {
  for (std::size_t k = 0; k < text.size(); ++k)
    if (control_bytes(text, k) > 0) return true;
  return false;
}

std::vector<std::string> lines_of(std::string_view words, std::size_t columns) {
  std::vector<std::string> lines;
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
    if (lines.empty() || columns_of(lines.back()) + 1 + columns_of(word) > columns)
      lines.emplace_back(word);
    else
      lines.back() += " " + std::string(word);
  }
  return lines;
}

std::string within_width(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) out += filled(line, last_column(line));
  if (text.empty() || text.back() != '\n') out.erase(out.find_last_not_of('\n') + 1);
  return out;
}

std::string markdown_within_width(const std::string& text) {
  std::istringstream lines(text);
  std::string out, paragraph;
  bool code = false;
  const auto close = [&] {
    if (!paragraph.empty()) out += filled(paragraph, hanging_indent(paragraph));
    paragraph.clear();
  };
  for (std::string line; std::getline(lines, line);) {
    const std::string begin = line.substr(indent_of(line), 3);
    const bool fence = begin == "```", item = begin.substr(0, 2) == "- ";
    if (fence || code || begin.empty() || begin[0] == '|' || begin[0] == '#' || begin.substr(0, 2) == "$$") {
      close();
      out += line + "\n";
      code = code != fence;
    } else if (!paragraph.empty() && !item && indent_of(line) == hanging_indent(paragraph)) {
      paragraph += " " + line.substr(indent_of(line));
    } else {
      close();
      paragraph = line;
    }
  }
  close();
  return out;
}

std::string_view next_word(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  text.remove_prefix(begin);
  const std::size_t end = std::min(text.find_first_of(" \t\r"), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

std::optional<double> leading_number(std::string_view text, std::size_t* length) {
  const std::size_t at = std::min(text.find_first_not_of(" \t\n"), text.size());
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  if (length) *length = static_cast<std::size_t>(end - text.data());
  return value;
}

bool is_utf8(std::string_view text) {
  for (std::size_t k = 0; k < text.size();) {
    const unsigned first = byte_at(text, k);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xc2 && first < 0xe0 ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || k + length > text.size()) return false;
    for (std::size_t i = 1; i < length; ++i)
      if ((byte_at(text, k + i) & 0xc0) != 0x80) return false;
    // Overlong forms, surrogates, and what lies beyond Unicode.
    const unsigned second = byte_at(text, k + 1);
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) || (first == 0xf0 && second < 0x90) ||
        (first == 0xf4 && second >= 0x90))
      return false;
    k += length;
  }
  return true;
}

std::string printable(const std::string& text, std::size_t longest) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::size_t bytes = control_bytes(text, k);
    if (text[k] == '\n')
      out += "\\n";
    else if (bytes > 0)
      out += fmt::format("\\x{:02x}", byte_at(text, k + bytes - 1));
    else
      out += text[k];
    if (bytes == 2) ++k;
  }
  if (out.size() <= longest) return out;
  // Never in the middle of a UTF-8 sequence.
  while (longest > 0 && (static_cast<unsigned char>(out[longest]) & 0xc0) == 0x80) --longest;
  return out.substr(0, longest) + "...";
}

void refuse_control_characters(char** argv) {
  for (; *argv; ++argv) {
    const std::string word = *argv;
    if (has_control_character(word))
      throw InputError({"", 0, printable(word, 60)}, "holds a control character, such as a newline",
                       "rename it without");
    if (!is_utf8(word))
      throw InputError({"", 0, "the command line"}, "holds a word that is not UTF-8", "rename the file");
  }
}

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string lammps_quoted(const std::string& text) {
  if (has_control_character(text))
    throw InputError({printable(text), 0, ""}, "holds a control character, such as a newline", "rename it without");
  const auto plain = [](char c) {
    return is_word_character(c) || std::string_view("_-+./:=,@~").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  for (const char quote : {'"', '\''})
    if (text.find(quote) == std::string::npos) return quote + text + quote;
  throw InputError({text, 0, ""}, "has both kinds of quotes in its name, which LAMMPS then cannot read",
                   "rename it without them");
}

std::string lammps_comment(const std::string& text) {
  constexpr std::size_t longest = 80;
  std::string out = text.substr(0, longest);
  for (char& c : out)
    if (!is_word_character(c) && std::string_view(" .,:;+-=_()/").find(c) == std::string_view::npos) c = '_';
  return out;
}

}  // namespace ropewalk
