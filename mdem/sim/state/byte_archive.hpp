// Numbers as the bytes that this machine has them in, for checkpoints.
#pragma once

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace ropewalk {

struct ByteWriter {
  std::string bytes;

  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
};

struct ByteReader {
  std::string_view bytes;  // that are not yet read

  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  // Throws std::runtime_error where there are fewer.
  std::string_view take(std::size_t count) {
    if (bytes.size() < count) throw std::runtime_error("the checkpoint ends too early");
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(count);
    return taken;
  }
};

}  // namespace ropewalk
