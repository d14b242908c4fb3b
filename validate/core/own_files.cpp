#include "core/own_files.hpp"

#include <filesystem>

#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {

void refuse_foreign_file(const std::string& path, const std::string& mark) {
  refuse_strange(path);
  if (std::filesystem::exists(path) && read_file(path).find(mark) == std::string::npos)
    throw InputError({path, 0, "--out"}, "exists, and this program did not make it",
                     "take it away, or choose another directory");
}

}  // namespace ropewalk::validate
