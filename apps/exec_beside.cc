// SPDX-License-Identifier: Apache-2.0
#include "apps/exec_beside.h"

#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace bodyloom {

std::filesystem::path ProgramBeside(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

void ExecBeside(const std::string& name, const std::vector<std::string>& arguments) {
  const std::filesystem::path program = ProgramBeside(name);
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  if (errno != ENOENT) {
    throw std::runtime_error(program.string() + ": cannot be started: " + std::strerror(errno));
  }
}

}  // namespace bodyloom
