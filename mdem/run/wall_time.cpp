#include "run/wall_time.hpp"

#include <algorithm>
#include <ctime>
#include <regex>

#include "model/error.hpp"

namespace ropewalk {

namespace {

const double started = steady_seconds();

}  // namespace

double program_start() { return started; }

double seconds_of_wall_time(const std::string& text) {
  if (text.empty()) return 0;
  std::smatch m;
  double seconds = 0;
  if (std::regex_match(text, m, std::regex(R"((?:(\d{1,4})-)?(\d{1,4}):([0-5]\d):([0-5]\d))")))
    seconds = 86400 * (m[1].matched ? std::stod(m[1]) : 0) + 3600 * std::stod(m[2]) + 60 * std::stod(m[3]) +
              std::stod(m[4]);
  else if (std::regex_match(text, std::regex(R"(\d{1,9})")))
    seconds = std::stod(text);
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
