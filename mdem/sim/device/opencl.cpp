#include <stdexcept>

#include "sim/device/device.hpp"

#ifdef ROPEWALK_HAS_OPENCL_HEADERS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <vector>

#include "model/bond.hpp"
#include "sim/device/kernel_text.hpp"

namespace ropewalk {
#include "sim/device/types.h"
namespace {

// The functions of OpenCL's library, which is opened once and stays.
struct OpenCl {
  void* const library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);

  template <class F>
  F* function(F*, const char* name) const {
    return library ? reinterpret_cast<F*>(dlsym(library, name)) : nullptr;
  }
#define ROPEWALK_OPENCL(name) decltype(&cl##name) const name = function(decltype (&cl##name)(nullptr), "cl" #name)
  ROPEWALK_OPENCL(GetPlatformIDs);
  ROPEWALK_OPENCL(GetPlatformInfo);
  ROPEWALK_OPENCL(GetDeviceIDs);
  ROPEWALK_OPENCL(GetDeviceInfo);
  ROPEWALK_OPENCL(CreateContext);
  ROPEWALK_OPENCL(ReleaseContext);
  ROPEWALK_OPENCL(CreateCommandQueue);
  ROPEWALK_OPENCL(ReleaseCommandQueue);
  ROPEWALK_OPENCL(CreateProgramWithSource);
  ROPEWALK_OPENCL(BuildProgram);
  ROPEWALK_OPENCL(GetProgramBuildInfo);
  ROPEWALK_OPENCL(ReleaseProgram);
  ROPEWALK_OPENCL(CreateKernel);
  ROPEWALK_OPENCL(SetKernelArg);
  ROPEWALK_OPENCL(ReleaseKernel);
  ROPEWALK_OPENCL(CreateBuffer);
  ROPEWALK_OPENCL(ReleaseMemObject);
  ROPEWALK_OPENCL(EnqueueWriteBuffer);
  ROPEWALK_OPENCL(EnqueueReadBuffer);
  ROPEWALK_OPENCL(EnqueueNDRangeKernel);
#undef ROPEWALK_OPENCL

  bool there() const { return library && GetPlatformIDs && EnqueueNDRangeKernel; }
};

const OpenCl& cl() {
  static const OpenCl opened;
  return opened;
}

void check(cl_int code, const char* what) {
  if (code == CL_SUCCESS) return;
  const bool memory = code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES ||
                      code == CL_OUT_OF_HOST_MEMORY || code == CL_INVALID_BUFFER_SIZE;
  throw std::runtime_error(std::string("the device failed: ") + what + " gave OpenCL's error " +
                           std::to_string(code) + (memory ? ": it has too little memory, or a kernel failed" : ""));
}

// `get(size, value, size_needed)` of one of OpenCL's functions for names.
template <class Get>
std::string text(const Get& get) {
  std::size_t size = 0;
  if (get(0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::string out(size, ' ');
  get(size, out.data(), nullptr);
  return out.substr(0, out.find('\0'));
}
std::string text_of(cl_platform_id platform) {
  return text([&](std::size_t size, char* to, std::size_t* needed) {
    return cl().GetPlatformInfo(platform, CL_PLATFORM_NAME, size, to, needed);
  });
}
std::string text_of(cl_device_id device, cl_device_info what) {
  return text([&](std::size_t size, char* to, std::size_t* needed) {
    return cl().GetDeviceInfo(device, what, size, to, needed);
  });
}

struct Found {
  cl_device_id device;
  cl_device_type type;
  std::string name;
};

std::vector<Found> all_devices() {
  std::vector<Found> found;
  if (!cl().there()) return found;
  cl_uint count = 0;
  if (cl().GetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return found;
  std::vector<cl_platform_id> platforms(count);
  check(cl().GetPlatformIDs(count, platforms.data(), nullptr), "the search for platforms");
  for (const cl_platform_id platform : platforms) {
    if (cl().GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS) continue;
    std::vector<cl_device_id> devices(count);
    check(cl().GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr),
          "the search for devices");
    for (const cl_device_id device : devices) {
      cl_device_type type = 0;
      check(cl().GetDeviceInfo(device, CL_DEVICE_TYPE, sizeof type, &type, nullptr), "the type of a device");
      found.push_back({device, type, text_of(platform) + ": " + text_of(device, CL_DEVICE_NAME)});
    }
  }
  return found;
}

std::string lower(std::string s) {
  std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return s;
}

std::string names_of(const std::vector<Found>& all) {
  if (all.empty()) return cl().there() ? "OpenCL has no device here" : "libOpenCL.so.1 is not installed here";
  std::string out = "OpenCL has";
  for (const Found& f : all) out += (&f == &all.front() ? " \"" : ", \"") + f.name + "\"";
  return out;
}

Found choose(const std::string& part, bool gpu_only) {
  const std::vector<Found> all = all_devices();
  std::string without_doubles;
  for (const Found& f : all) {
    if (gpu_only && !(f.type & CL_DEVICE_TYPE_GPU)) continue;
    if (lower(f.name).find(lower(part)) == std::string::npos) continue;
    if (text_of(f.device, CL_DEVICE_EXTENSIONS).find("cl_khr_fp64") != std::string::npos) return f;
    without_doubles = f.name;
  }
  if (!without_doubles.empty())
    throw std::invalid_argument("\"" + without_doubles + "\" has no numbers of double precision (cl_khr_fp64)");
  throw std::invalid_argument(
      (gpu_only ? std::string("no GPU was found") : "no device has \"" + part + "\" in its name") + "; " +
      names_of(all));
}

class OpenClDevice : public Device {
 public:
  OpenClDevice(const Found& found, const KernelShape& shape) : name_(found.name) {
    cl_int code = CL_SUCCESS;
    context_ = {cl().CreateContext(nullptr, 1, &found.device, nullptr, nullptr, &code), cl().ReleaseContext};
    check(code, "a context");
    queue_ = {cl().CreateCommandQueue(context_.get(), found.device, 0, &code), cl().ReleaseCommandQueue};
    check(code, "a queue");
    std::ostringstream source;
    source << "#define NODES " << shape.nodes << "\n#define TYPES " << shape.types
           << "\n#define LOCAL_TYPES TYPES\n"
           << forms_dialect_text << forms_text << kernel_dialect_text << kernel_types_text << kernel_text;
    const std::string written = source.str();
    const char* begin = written.c_str();
    const std::size_t length = written.size();
    program_ = {cl().CreateProgramWithSource(context_.get(), 1, &begin, &length, &code), cl().ReleaseProgram};
    check(code, "the kernels");
    cl_device_fp_config floats = 0;
    check(cl().GetDeviceInfo(found.device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof floats, &floats, nullptr),
          "its floats");
    const bool rounds = (floats & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    if (!rounds || !(floats & CL_FP_DENORM)) name_ += " (floats not all by IEEE 754: other last digits)";
    const char* const options = rounds ? "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt" : "-cl-std=CL1.2";
    code = cl().BuildProgram(program_.get(), 1, &found.device, options, nullptr, nullptr);
    if (code != CL_SUCCESS) {
      const std::string log = text([&](std::size_t size, char* to, std::size_t* needed) {
        return cl().GetProgramBuildInfo(program_.get(), found.device, CL_PROGRAM_BUILD_LOG, size, to, needed);
      });
      throw std::runtime_error("the compiler of \"" + name_ + "\" refused the kernels, OpenCL's error " +
                               std::to_string(code) + ": " + log);
    }
  }

  std::string name() const override { return name_; }

  Memory allocate(std::size_t bytes) override {
    cl_int code = CL_SUCCESS;
    const cl_mem memory =
        cl().CreateBuffer(context_.get(), CL_MEM_READ_WRITE, std::max<std::size_t>(bytes, 16), nullptr, &code);
    check(code, "memory");
    return {memory, [](void* m) { cl().ReleaseMemObject(static_cast<cl_mem>(m)); }};
  }
  void write(const Memory& to, const void* from, std::size_t bytes) override { write(to, from, bytes, CL_TRUE); }
  void write_later(const Memory& to, const void* from, std::size_t bytes) override {
    write(to, from, bytes, CL_FALSE);
  }
  void read(const Memory& from, void* to, std::size_t bytes) override {
    if (bytes == 0) return;
    check(cl().EnqueueReadBuffer(queue_.get(), static_cast<cl_mem>(from.get()), CL_TRUE, 0, bytes, to, 0, nullptr,
                                 nullptr),
          "a copy from it");
  }

 protected:
  void launch(const char* name, int groups, const Argument* arguments, int count) override {
    if (groups == 0) return;
    const cl_kernel kernel = kernel_of(name);
    for (int k = 0; k < count; ++k)
      check(cl().SetKernelArg(kernel, static_cast<cl_uint>(k), arguments[k].bytes, arguments[k].at), name);
    const std::size_t group = GROUP, items = group * static_cast<std::size_t>(groups);
    check(cl().EnqueueNDRangeKernel(queue_.get(), kernel, 1, nullptr, &items, &group, 0, nullptr, nullptr), name);
  }

 private:
  template <class T>
  using Held = std::shared_ptr<std::remove_pointer_t<T>>;

  void write(const Memory& to, const void* from, std::size_t bytes, cl_bool waits) {
    if (bytes == 0) return;
    check(cl().EnqueueWriteBuffer(queue_.get(), static_cast<cl_mem>(to.get()), waits, 0, bytes, from, 0, nullptr,
                                  nullptr),
          "a copy to it");
  }

  cl_kernel kernel_of(const char* name) {
    Held<cl_kernel>& kernel = kernels_[name];
    if (!kernel) {
      cl_int code = CL_SUCCESS;
      kernel = {cl().CreateKernel(program_.get(), name, &code), cl().ReleaseKernel};
      check(code, name);
    }
    return kernel.get();
  }

  std::string name_;
  Held<cl_context> context_;
  Held<cl_command_queue> queue_;
  Held<cl_program> program_;
  std::map<std::string, Held<cl_kernel>> kernels_;
};

}  // namespace

std::unique_ptr<Device> open_opencl(const std::string& part, bool gpu_only, const KernelShape& shape) {
  return std::make_unique<OpenClDevice>(choose(part, gpu_only), shape);
}

}  // namespace ropewalk

#else

namespace ropewalk {

std::unique_ptr<Device> open_opencl(const std::string&, bool, const KernelShape&) {
  throw std::invalid_argument(
      "this program was built without the headers of OpenCL (Debian: opencl-c-headers); build it again with them");
}

}  // namespace ropewalk
#endif
