// hash_hex() of io/files.hpp of a text that comes in parts.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace ropewalk {

class RunningHash {
 public:
  RunningHash();
  ~RunningHash();
  void add(std::string_view part);
  std::string hex() const;

 private:
  struct Sum;
  std::unique_ptr<Sum> sum_;
};

}  // namespace ropewalk
