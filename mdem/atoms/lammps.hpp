// LAMMPS as a child process, since Debian's liblammps ends the calling process on an error. Each run has a folder
// with its input, log and screen output.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/disk_full.hpp"
#include "model/error.hpp"

namespace ropewalk {

struct LammpsVersion {
  std::string text;  // "29 Sep 2021 - Update 2"
  std::vector<std::string> packages;
  std::vector<std::string> pair_styles;
  bool has_pair_style(const std::string& style) const;
};

struct LammpsOptions {
  std::string program = "lmp";         // ROPEWALK_LMP overrides
  double quiet_seconds = 120;          // killed when it has written nothing for so long
  double max_seconds = 3600;           // killed after so long
  long long most_bytes = 256LL << 20;  // killed when its files are so long
  std::function<bool()> interrupted;   // asked often; ends the child where it says true. May be empty
};

// Failure of the child: its ERROR line, its last command, the folder, and a remedy. Exit code 3.
class LammpsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The disk of the child's files is full.
class LammpsDiskFull : public LammpsError, public DiskFull {
 public:
  using LammpsError::LammpsError;
};

// Throws LammpsDiskFull where the disk that a folder of LAMMPS lies on is full. LAMMPS does not check its own
// writes: it ends well, and leaves files cut short or none.
void refuse_full_disk(const std::string& folder);

// Version, packages and pair styles of the program. Throws InputError with the apt line if there is no LAMMPS.
LammpsVersion lammps_version(const LammpsOptions& options);

// Writes `input` to folder/name.in and runs it on one core with the folder as working directory; output in
// name.log and name.out. Ends the child when this process gets SIGINT or SIGTERM, or dies.
// Throws LammpsError when the child fails, hangs or is killed, and InputError when the folder cannot be written.
void run_lammps(const std::string& folder, const std::string& name, const std::string& input,
                const LammpsOptions& options);

}  // namespace ropewalk
