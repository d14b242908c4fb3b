// Means of named quantities over several samples of a motion.
#pragma once

#include <map>
#include <string>

namespace ropewalk {

class Means {
 public:
  // Every sample must have the same names.
  void add(const std::map<std::string, double>& now) {
    for (const auto& [name, value] : now) sums_[name] += value;
    ++count_;
  }
  std::map<std::string, double> values() const {
    std::map<std::string, double> out;
    for (const auto& [name, sum] : sums_) out[name] = sum / count_;
    return out;
  }

 private:
  std::map<std::string, double> sums_;
  int count_ = 0;
};

}  // namespace ropewalk
