// The two ways in which a user's request can fail. Libraries throw these and never print; main catches
// them once and turns them into one line and an exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace ropewalk {

// Wrong input. Printed as "file:line: key: what; remedy", exit code 2.
class InputError : public std::runtime_error {
 public:
  struct Place {
    std::string file;  // empty: the command line
    int line = 0;      // 0: not known
    std::string key;   // the offending key, option or column; may be empty
  };

  InputError(Place place, std::string what, std::string remedy)
      : std::runtime_error(compose(place, what, remedy)), place_(std::move(place)) {}

  const Place& place() const { return place_; }

 private:
  static std::string compose(const Place& p, const std::string& what, const std::string& remedy) {
    std::string text = p.file;
    if (p.line > 0) text += ":" + std::to_string(p.line);
    if (!text.empty()) text += ": ";
    if (!p.key.empty()) text += p.key + ": ";
    text += what;
    if (!remedy.empty()) text += "; " + remedy;
    return text;
  }

  Place place_;
};

// The calculation itself went wrong (NaN, blow-up, a bond about to slip). Exit code 3. The message names
// step, element and remedy; the state at that moment has been written by the time it reaches main.
class NumericalError : public std::runtime_error {
 public:
  enum class ShorterSteps { may_help, cannot_help };

  NumericalError(long step, int element, const std::string& what, const std::string& remedy,
                 ShorterSteps shorter_steps = ShorterSteps::may_help)
      : std::runtime_error("step " + std::to_string(step) +
                           (element >= 0 ? ", element " + std::to_string(element) : std::string()) + ": " + what +
                           "; " + remedy),
        step_(step),
        element_(element),
        shorter_steps_(shorter_steps) {}

  long step() const { return step_; }
  int element() const { return element_; }
  ShorterSteps shorter_steps() const { return shorter_steps_; }

 private:
  long step_;
  int element_;
  ShorterSteps shorter_steps_;
};

}  // namespace ropewalk
