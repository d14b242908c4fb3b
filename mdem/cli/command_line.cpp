#include "cli/command_line.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "io/plain_text.hpp"

namespace ropewalk {
namespace {

using Verb = const CLI::App*;
using Option = const CLI::Option*;

// The verbs that --help lists.
std::vector<Verb> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

std::vector<Option> options_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* o) { return o->nonpositional() && !o->get_group().empty(); });
}

// "-o", "--out"
std::vector<std::string> names_of(Option o) {
  std::vector<std::string> names;
  for (const std::string& s : o->get_snames()) names.push_back("-" + s);
  for (const std::string& l : o->get_lnames()) names.push_back("--" + l);
  return names;
}

std::vector<std::string> all_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (Option o : options_of(app))
    for (const std::string& name : names_of(o)) names.push_back(name);
  return names;
}

bool takes_value(Option o) { return o->get_items_expected_max() > 0; }

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : " ") + w;
  return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (Verb verb : verbs_of(app)) names.push_back(verb->get_name());
  return joined(names);
}

class HelpWithinWidth : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return within_width(CLI::Formatter::make_help(app, std::move(name), mode));
  }
};

// --- man ---

std::string roff(const std::string& text) {
  std::string out = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (!out.empty() && (out[0] == '.' || out[0] == '\'')) out = "\\&" + out;
  return replaced(replaced(out, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

// "INT" of "INT:INT in [1 - 8]".
std::string value_name(Option o) {
  const std::string type = o->get_type_name();
  return type.empty() ? "value" : type.substr(0, type.find(':'));
}

std::string roff_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* o : app.get_options()) {
    if (o->get_group().empty()) continue;
    const bool named = o->nonpositional();
    std::string head;
    for (const std::string& name : named ? names_of(o) : std::vector<std::string>{o->get_name(true)})
      head += (head.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
    if (named && takes_value(o)) head += " \\fI" + roff(value_name(o)) + "\\fR";
    text += ".TP\n" + head + "\n" + roff(o->get_description()) + "\n";
  }
  return text;
}

// --- Shells ---

// Quotes a word for a shell.
std::string quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

// Within [...] of zsh's _arguments, in single quotes.
std::string zsh_words(const std::string& text) {
  std::string out = text;
  for (const char* c : {"\\", "[", "]", ":"}) out = replaced(out, c, std::string("\\") + c);
  return replaced(out, "'", "'\\''");
}

std::string identifier(const std::string& program) { return "_" + replaced(program, "-", "_"); }

// The values that an option takes, where it names them: those of the description, or "a" and "b" of "TEXT:{a,b}".
std::vector<std::string> option_values(Option o, const Description& d) {
  for (const std::string& name : names_of(o))
    if (const auto at = d.values.find(name); at != d.values.end()) return at->second;
  const std::string type = o->get_type_name();
  const std::size_t open = type.find('{'), close = type.rfind('}');
  if (open == std::string::npos || close < open) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string zsh_arguments(const CLI::App& app, const Description& d) {
  std::string text;
  for (Option o : options_of(app))
    for (const std::string& name : names_of(o)) {
      const std::vector<std::string> values = option_values(o, d);
      text += fmt::format(" \\\n        '{}[{}]{}'", name, zsh_words(o->get_description()),
                          !takes_value(o)  ? ""
                          : values.empty() ? ":value:_files"
                                           : ":value:(" + joined(values) + ")");
    }
  return text;
}

// The branches of bash that take the values of options.
std::string bash_values(const CLI::App& app, const Description& d) {
  std::string text;
  for (Option o : options_of(app)) {
    std::string names;
    for (const std::string& name : names_of(o)) names += (names.empty() ? "" : "|") + name;
    if (const auto values = option_values(o, d); takes_value(o) && !values.empty())
      text += fmt::format(" {}) words='{}' named=yes ;;", names, joined(values));
  }
  return text.empty() ? "" : fmt::format(" case $previous in{} esac ;", text);
}

// Empty where the value is allowed.
std::string refusal(const std::string& text, double value, const Bounds& bounds) {
  return bounds.allow(value) ? "" : printable(text, 60) + " " + bounds.words();
}

}  // namespace

void keep_help_within_width(CLI::App& app) { app.formatter(std::make_shared<HelpWithinWidth>()); }

int run_program(CLI::App& app, int argc, const Program& program, const char* name, const std::string& typed,
                const std::function<void()>& before, int (*failed)(const char*, const std::exception&)) {
  try {
    refuse_control_characters(program.argv);
    if (before) before();
    app.parse(argc, program.argv);
    return code_at_exit(name, program.code);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return code_at_exit(name, app.exit(e));
    std::fprintf(stderr, "%s: %s\n", name, usage_error(app, e, typed).c_str());
    return 2;
  } catch (const std::exception& e) {
    return failed(name, e);
  }
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error, const std::string& program) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App& at = parsed.empty() ? app : *parsed.front();
  const std::string here = parsed.empty() ? program : program + " " + at.get_name();
  const std::string help = "; see " + here + " --help";
  const auto with_nearest = [&](const std::string& what, const std::string& word,
                                const std::vector<std::string>& known) {
    const std::string near = nearest_word(word, known);
    return what + (near.empty() ? help : "; did you mean " + near + "?");
  };
  const std::vector<std::string> strays = app.remaining(true);
  for (const std::string& word : strays)
    if (word.size() > 1 && word[0] == '-') {
      const std::string name = word.substr(0, word.find('='));
      const std::string of = parsed.empty() ? "" : " of " + at.get_name();
      return with_nearest(fmt::format("there is no option {}{}", printable(name, 60), of), name, all_names(at));
    }
  if (parsed.empty() && !strays.empty() && !verbs_of(app).empty()) {
    std::vector<std::string> known;
    for (Verb verb : verbs_of(app)) known.push_back(verb->get_name());
    return with_nearest(fmt::format("there is no verb \"{}\"", printable(strays.front(), 60)), strays.front(),
                        known);
  }
  return printable(error.what(), 1000) + help;
}

CLI::Validator number_within(const Bounds& bounds) {
  return {[bounds](const std::string& text) {
            double value = 0;
            const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
            return number ? refusal(text, value, bounds) : printable(text, 60) + " is not a number";
          },
          ""};
}

CLI::Validator whole_number(int least, int most) {
  const Bounds bounds = most == unbounded ? Bounds::range(least, std::numeric_limits<double>::infinity())
                                          : Bounds::range(least, most);
  return {[bounds](const std::string& text) {
            long value = 0;
            return CLI::detail::lexical_cast(text, value) ? refusal(text, static_cast<double>(value), bounds)
                                                          : printable(text, 60) + " is not a whole number";
          },
          ""};
}

std::string man_page(const CLI::App& app, const Description& d) {
  const std::string about = app.get_description(), own = d.program + " ";
  // Its first sentence, without its own name in front.
  const std::size_t begin = about.rfind(own, 0) == 0 ? own.size() : 0, end = about.find_first_of(".\n");
  std::string text =
      fmt::format(".TH {} 1 \"\" \"Ropewalk {}\" \"Ropewalk\"\n.SH NAME\n{} \\- {}\n", roff(d.program),
                  roff(d.version), roff(d.program), roff(about.substr(begin, end - begin)));
  text += fmt::format(".SH SYNOPSIS\n.B {}\n\\fIverb\\fR [\\fIarguments\\fR]\n.SH DESCRIPTION\n.nf\n{}\n.fi\n",
                      roff(d.program), roff(about));
  text += ".SH OPTIONS\n" + roff_options(app) + ".SH VERBS\n";
  for (Verb verb : verbs_of(app))
    text +=
        fmt::format(".SS {}\n{}\n{}", roff(verb->get_name()), roff(verb->get_description()), roff_options(*verb));
  if (!d.long_text.empty()) text += ".SH SCENES\n.nf\n" + roff(d.long_text) + "\n.fi\n";
  return text;
}

std::string bash_completion(const CLI::App& app, const Description& d) {
  const std::string name = identifier(d.program);
  std::string text = fmt::format(
      "# bash completion of {0}\n{1}() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} verb= words= values= "
      "named= word\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
      "    if [[ $word != -* ]]; then verb=$word; break; fi\n"
      "  done\n"
      "  case $verb in\n    '') words='{2} {3}' ;{4};\n",
      d.program, name, verb_names(app), joined(all_names(app)), bash_values(app, d));
  for (const std::string& verb : d.siblings) {
    const std::string other = d.program + "-" + verb, function = identifier(other);
    text += fmt::format(
        "    {0}) declare -F {1} >/dev/null || source \"${{BASH_SOURCE[0]%/*}}/{2}\"\n"
        "      COMP_WORDS=({2} \"${{COMP_WORDS[@]:2}}\") COMP_CWORD=$((COMP_CWORD-1)); {1}; return ;;\n",
        verb, function, other);
  }
  for (Verb verb : verbs_of(app)) {
    const auto values = d.values.find(verb->get_name());
    text += fmt::format("    {}) words='{}' {};{};\n", verb->get_name(), joined(all_names(*verb)),
                        values == d.values.end() ? "" : "values='" + joined(values->second) + "' ",
                        bash_values(*verb, d));
  }
  return text + fmt::format(
                    "  esac\n"
                    "  if [[ $current == -* || -z $verb || -n $named ]]; then\n"
                    "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
                    "  else\n"
                    "    mapfile -t COMPREPLY < <(compgen -W \"$values\" -f -- \"$current\")\n"
                    "  fi\n}}\ncomplete -o filenames -F {} {}\n",
                    name, d.program);
}

std::string zsh_completion(const CLI::App& app, const Description& d) {
  std::string text =
      fmt::format("#compdef {0}\n{1}() {{\n  local -a verbs\n  verbs=(\n", d.program, identifier(d.program));
  for (Verb verb : verbs_of(app))
    text += fmt::format("    {}\n", quoted(verb->get_name() + ":" + verb->get_description()));
  text += fmt::format(
      "  )\n  _arguments -C{} \\\n        '1:verb:->verb' '*::rest:->rest'\n"
      "  case $state in\n    verb) _describe verb verbs ;;\n    rest)\n      case $words[1] in\n",
      zsh_arguments(app, d));
  for (Verb verb : verbs_of(app))
    text += fmt::format("      {}) _arguments{} \\\n        '*:file:_files' ;;\n", verb->get_name(),
                        zsh_arguments(*verb, d));
  return text + fmt::format("      esac ;;\n  esac\n}}\n{} \"$@\"\n", identifier(d.program));
}

std::string fish_completion(const CLI::App& app, const Description& d) {
  std::string text = "# fish completion of " + d.program + "\n";
  const auto add = [&](const CLI::App& of, const std::string& where) {
    for (Option o : options_of(of)) {
      text += "complete -c " + d.program + " -n " + quoted(where);
      for (const std::string& s : o->get_snames()) text += " -s " + s;
      for (const std::string& l : o->get_lnames()) text += " -l " + l;
      if (const auto values = option_values(o, d); takes_value(o) && !values.empty())
        text += " -f -a " + quoted(joined(values));
      text += (takes_value(o) ? " -r -d " : " -d ") + quoted(o->get_description()) + "\n";
    }
  };
  add(app, "__fish_use_subcommand");
  for (Verb verb : verbs_of(app)) {
    text += fmt::format("complete -c {} -f -n __fish_use_subcommand -a {} -d {}\n", d.program, verb->get_name(),
                        quoted(verb->get_description()));
    add(*verb, "__fish_seen_subcommand_from " + verb->get_name());
  }
  return text;
}

nlohmann::ordered_json json_options(const CLI::App& app) {
  auto out = nlohmann::ordered_json::array();
  for (Option o : app.get_options()) {
    if (o->get_group().empty()) continue;
    const bool named = o->nonpositional();
    out.push_back({{"names", named ? names_of(o) : std::vector<std::string>{o->get_name(true)}},
                   {"positional", !named},
                   {"required", o->get_required()},
                   {"value", named && takes_value(o) ? value_name(o) : ""},
                   {"default", o->get_default_str()},
                   {"meaning", o->get_description()}});
  }
  return out;
}

std::string json_description(const CLI::App& app, const Description& d) {
  nlohmann::ordered_json out = {{"program", d.program},
                                {"version", d.version},
                                {"about", app.get_description()},
                                {"options", json_options(app)},
                                {"verbs", nlohmann::ordered_json::array()}};
  for (Verb verb : verbs_of(app))
    out["verbs"].push_back(
        {{"name", verb->get_name()}, {"meaning", verb->get_description()}, {"options", json_options(*verb)}});
  out.update(d.more);
  return out.dump(1) + "\n";
}

void add_describe(CLI::App& app, const std::function<Description()>& describe) {
  CLI::App* c = app.add_subcommand("describe")->group("");
  auto what = std::make_shared<std::string>();
  c->add_option("what", *what)->required()->check(CLI::IsMember({"man", "bash", "zsh", "fish", "json"}));
  c->callback([&app, describe, what] {
    const Description d = describe();
    const std::string text = *what == "man"    ? man_page(app, d)
                             : *what == "bash" ? bash_completion(app, d)
                             : *what == "zsh"  ? zsh_completion(app, d)
                             : *what == "fish" ? fish_completion(app, d)
                                               : json_description(app, d);
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace ropewalk
