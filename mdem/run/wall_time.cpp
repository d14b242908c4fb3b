#include "run/wall_time.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "model/error.hpp"

namespace ropewalk {

namespace {

const double started = steady_seconds();

}  // namespace

double program_start() { return started; }

double seconds_of_wall_time(const std::string& text) {
  if (text.empty()) return 0;
  unsigned days = 0, hours = 0, minutes = 0, whole_seconds = 0;
  const auto is = [&](const char* form, int fields, auto*... field) {
    int end = -1;
    return std::sscanf(text.c_str(), form, field..., &end) == fields && end == static_cast<int>(text.size());
  };
  const bool read =
      text.front() != '-' && text.find_first_not_of("0123456789:-") == std::string::npos &&
      (is("%9u%n", 1, &whole_seconds) || ((is("%4u:%2u:%2u%n", 3, &hours, &minutes, &whole_seconds) ||
                                           is("%4u-%4u:%2u:%2u%n", 4, &days, &hours, &minutes, &whole_seconds)) &&
                                          days < 10000 && hours < 10000 && minutes < 60 && whole_seconds < 60));
  const double seconds = read ? 86400.0 * days + 3600.0 * hours + 60.0 * minutes + whole_seconds : 0;
  if (!(seconds > 0))
    throw InputError({"", 0, "--wall-time"}, "\"" + text + "\" is no time",
                     "take seconds, as 5400, or H:MM:SS, as 1:30:00 or 2-12:00:00");
  return seconds;
}

bool WallTime::is_up(double last_save) const {
  if (allowed <= 0) return false;
  const double reserve = std::min(5 + 3 * last_save, 0.5 * allowed);
  return steady_seconds() - since > allowed - reserve;
}

std::string RunClock::iso_time() {
  const std::time_t t = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&t, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace ropewalk
