#include "plugin/plugin_loader.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <exception>
#include <set>
#include <string>
#include <system_error>

#include "gridmerge/base/error.hpp"
#include "plugin/method_plugin.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;

/// What the dynamic linker complains of, without the file's name before it.
std::string linker_error(const fs::path& file) {
  const char* told = dlerror();
  const std::string text = told == nullptr ? "unknown error" : told;
  const std::string prefix = file.string() + ": ";
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

/// Where the file really lies.
fs::path found(const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) {
    throw InputError(file.string(), error == std::errc::no_such_file_or_directory
                                        ? "does not exist"
                                        : "cannot be read: " + error.message());
  }
  if (!fs::is_regular_file(real, error)) {
    throw InputError(file.string(), "is no file");
  }
  return real;
}

/// A loaded library. It is never closed.
class Library {
 public:
  explicit Library(const fs::path& file) : name_(file.string()) {
    const fs::path real = found(file);
    handle_ = dlopen(real.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle_ == nullptr) {
      throw InputError(name_, "is not a shared library that can be loaded: " + linker_error(real));
    }
  }

  /// The exported function of that name.
  template <typename Function>
  [[nodiscard]] Function* function(const char* symbol) const {
    void* address = dlsym(handle_, symbol);
    if (address == nullptr) {
      throw InputError(name_, std::string("is not a gridmerge plugin: it has no symbol ") + symbol);
    }
    return reinterpret_cast<Function*>(address);
  }

 private:
  std::string name_;
  void* handle_ = nullptr;
};

void check_abi(const Library& library, const std::string& name) {
  const std::string theirs = library.function<const char*()>("gridmerge_plugin_abi")();
  if (theirs != GRIDMERGE_PLUGIN_ABI) {
    throw InputError(name, "was built for '" + theirs + "'; this program is '" GRIDMERGE_PLUGIN_ABI "'");
  }
  if (library.function<std::uint64_t()>("gridmerge_plugin_layout")() != plugin_layout()) {
    throw InputError(name, "was built with other headers than this gridmerge: build it anew");
  }
}

bool is_snake_case(const std::string& name) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && std::all_of(name.begin(), name.end(), fits);
}

/// What the registry cannot see for itself.
void check_added(const MethodRegistry& methods, std::size_t before, const std::string& name) {
  if (methods.entries().size() <= before) {
    throw InputError(name, "registers no method");
  }
  for (std::size_t i = before; i < methods.entries().size(); ++i) {
    const MethodEntry& entry = methods.entries()[i];
    if (!is_snake_case(entry.name)) {
      throw InputError(name, "method '" + entry.name + "': a name must be a word of a-z, 0-9 and _");
    }
    for (const MethodProfile& profile : entry.profiles) {
      if (!profile.config) {
        throw InputError(name, "method '" + entry.name + "': profile '" + profile.name + "' has no configuration");
      }
    }
  }
}

MethodRegistry with_plugin(const MethodRegistry& methods, const fs::path& file) {
  const std::string name = file.string();
  const Library library(file);
  check_abi(library, name);
  MethodRegistry extended = methods;
  try {
    library.function<void(MethodRegistry*)>("gridmerge_plugin_register")(&extended);
  } catch (const std::exception& error) {
    throw InputError(name, std::string("its registration failed: ") + error.what());
  } catch (...) {
    throw InputError(name, "its registration failed, and it does not say why");
  }
  check_added(extended, methods.entries().size(), name);
  return extended;
}

}  // namespace

MethodRegistry with_plugins(const MethodRegistry& methods, const std::vector<fs::path>& files) {
  MethodRegistry extended = methods;
  std::set<fs::path> loaded;
  for (const fs::path& file : files) {
    if (loaded.insert(found(file)).second) {
      extended = with_plugin(extended, file);
    }
  }
  return extended;
}

}  // namespace gridmerge
