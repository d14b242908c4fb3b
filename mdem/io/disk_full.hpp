// A kind of failure, beside others: the disk is full, and what the failing work has left tells nothing more.
#pragma once

namespace ropewalk {

struct DiskFull {
  virtual ~DiskFull() = default;
};

}  // namespace ropewalk
