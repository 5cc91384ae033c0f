#pragma once

#include <string>

namespace corridor {

/// A shared library of Corridor that is opened when it is first needed, so that the program does
/// not depend on the libraries that it uses.
struct OpenModule {
  void* handle = nullptr;  ///< null if the module can't be opened
  std::string why;         ///< then the reason
};

/// Opens a module: beside the program, or else in the folder of the build, or else on the program's
/// run path. It stays open. @param name of its file. @param buildFolder where it was built.
OpenModule openModule(const std::string& name, const std::string& buildFolder);

/// Returns a function of an open module, or null.
void* functionIn(const OpenModule& module, const char* name);

}  // namespace corridor
