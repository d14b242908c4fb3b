// Texts of users in places where something else interprets them: terminals, shells, LAMMPS.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ropewalk {

// C0, DEL and C1, the last in UTF-8.
bool has_control_character(std::string_view text);
bool is_utf8(std::string_view text);

// Takes the next word of a line off, with the spaces before it; empty: there is none.
std::string_view next_word(std::string_view& text);

// Columns of a terminal, which help and commented scenes fill.
constexpr std::size_t widest_line = 120;
// The words in lines of at most so many columns. A word that is longer has a line of its own.
std::vector<std::string> lines_of(std::string_view words, std::size_t columns);
// Each line that is wider than widest_line goes on below, as far in as its last column of words begins.
std::string within_width(const std::string& text);
// The same of Markdown, whose paragraphs are filled anew. Code, formulas, tables and headings stay as they are.
std::string markdown_within_width(const std::string& text);

// The number that a text begins with, behind spaces: with a decimal point, in every locale. `length`: of what was
// read.
std::optional<double> leading_number(std::string_view text, std::size_t* length = nullptr);

// The text with control characters as escapes, cut to fit into a line of a message.
std::string printable(const std::string& text, std::size_t longest = 200);

// Throws InputError where a word of the command line holds a control character or is not UTF-8: names of files and
// scenes go into messages, scripts and pages.
void refuse_control_characters(char** argv);

// One word of a POSIX shell, in quotes.
std::string shell_quoted(const std::string& text);

// One word of a LAMMPS command, in quotes where LAMMPS would read more than a name in it. Throws InputError where
// no quotes serve.
std::string lammps_quoted(const std::string& text);

// For a comment of LAMMPS or the first line of a data file: letters, digits and little else, cut to one line. There
// LAMMPS still obeys `&` at the end and three quotes, and it reads on where a line is too long.
std::string lammps_comment(const std::string& text);

}  // namespace ropewalk
