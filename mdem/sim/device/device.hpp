// A device runs the kernels of kernels.h. It is a processor that OpenCL offers, or the one of the program, which
// reads the same text as C++. A device carries out commands in the order of the calls. read() and write() return
// after all commands before them are done.
//
// OpenCL's library (libOpenCL.so.1) is opened when a device is asked for, so that the program needs it nowhere
// else.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <tuple>

namespace ropewalk {

// Numbers that are compiled into the kernels: nodes of an element, types of tubes.
struct KernelShape {
  int nodes = 1, types = 1;
};

class Device {
 public:
  using Memory = std::shared_ptr<void>;

  virtual ~Device() = default;
  virtual std::string name() const = 0;

  // The content of new memory is not defined. Throws std::runtime_error where the device has too little memory.
  virtual Memory allocate(std::size_t bytes) = 0;
  virtual void write(const Memory& to, const void* from, std::size_t bytes) = 0;
  // Copies at some time before the next read(). Until then the caller must not change `from`.
  virtual void write_later(const Memory& to, const void* from, std::size_t bytes) = 0;
  virtual void read(const Memory& from, void* to, std::size_t bytes) = 0;
  // Runs a kernel. The arguments are those of the kernel's text in their order: Memory for a pointer, else the
  // value.
  template <class... A>
  void run(const char* kernel, int groups, const A&... arguments) {
    const auto values = std::make_tuple(value_of(arguments)...);
    std::apply(
        [&](const auto&... value) {
          const std::array<Argument, sizeof...(A)> all{Argument{&value, sizeof value}...};
          launch(kernel, groups, all.data(), static_cast<int>(all.size()));
        },
        values);
  }

 protected:
  struct Argument {
    const void* at;
    std::size_t bytes;
  };
  virtual void launch(const char* kernel, int groups, const Argument* arguments, int count) = 0;

 private:
  static void* value_of(const Memory& memory) { return memory.get(); }
  template <class T>
  static const T& value_of(const T& value) {
    return value;
  }
};

// The name chooses the device:
//   gpu           the first GPU with doubles that OpenCL offers; never another kind of processor
//   opencl:TEXT   the first device of any kind with TEXT in the name of its platform or in its own
//   c++           this processor, with the threads of OpenMP
// Throws std::invalid_argument, in the words of a message to the user, where there is none.
std::unique_ptr<Device> open_device(const std::string& name, const KernelShape& shape);

// Implementations.
std::unique_ptr<Device> open_opencl(const std::string& text, bool gpu_only, const KernelShape& shape);
std::unique_ptr<Device> open_this_processor(const KernelShape& shape);

}  // namespace ropewalk
