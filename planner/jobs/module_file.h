#pragma once

#include <string>

namespace corridor {

/// A shared library of Corridor that is opened when it is first needed, so that the program does
/// not depend on the libraries that the module uses.
struct OpenModule {
  void* handle = nullptr;  ///< null if the module can't be opened
  std::string why;         ///< why the module can't be opened; "" if it is open
};

/// Opens a module: the first file of this name that can be opened in the folder of the program,
/// then in `buildFolder`, then on the program's run path. The module stays open. @param name the
/// file name of the module. @param buildFolder the folder in which the module was built.
OpenModule openModule(const std::string& name, const std::string& buildFolder);

/// Returns a function of a module by its name. Returns null if the module is not open or has no
/// such function.
void* functionIn(const OpenModule& module, const char* name);

}  // namespace corridor
