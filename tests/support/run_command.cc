// SPDX-License-Identifier: Apache-2.0
#include "tests/support/run_command.h"
#include "tests/support/paths.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <stdexcept>

namespace bodyloom {
namespace {

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
      throw std::runtime_error("no pipe");
    }
    read_end = ends[0];
    write_end = ends[1];
  }
};

/// In the child: never returns.
[[noreturn]] void BecomeCommand(const std::vector<std::string>& arguments, const CommandOptions& options, int out,
                                int err) {
  const std::string command = CommandPath();
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (options.file_size_limit) {
    const rlimit limit = {*options.file_size_limit, *options.file_size_limit};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (!options.work_folder.empty() && chdir(options.work_folder.c_str()) != 0) {
    _exit(126);
  }
  std::vector<char*> argv = {const_cast<char*>(command.c_str())};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  execv(command.c_str(), argv.data());
  _exit(127);
}

}  // namespace

int CommandResult::NumErrorLines() const { return static_cast<int>(std::count(err.begin(), err.end(), '\n')); }

CommandResult RunCommand(const std::vector<std::string>& arguments, const CommandOptions& options) {
  const Pipe out, err;
  const pid_t child = fork();
  if (child < 0) {
    throw std::runtime_error("cannot fork");
  }
  if (child == 0) {
    BecomeCommand(arguments, options, out.write_end, err.write_end);
  }
  close(out.write_end);
  close(err.write_end);
  CommandResult result;
  bool interrupted = options.interrupt_on.empty();
  std::array<pollfd, 2> ends = {{{out.read_end, POLLIN, 0}, {err.read_end, POLLIN, 0}}};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    poll(ends.data(), ends.size(), -1);
    for (size_t i = 0; i < ends.size(); ++i) {
      std::array<char, 4096> buffer;
      if (ends[i].fd < 0 || ends[i].revents == 0) {
        continue;
      }
      const ssize_t n = read(ends[i].fd, buffer.data(), buffer.size());
      if (n <= 0) {
        close(ends[i].fd);
        ends[i].fd = -1;
        continue;
      }
      (i == 0 ? result.out : result.err).append(buffer.data(), static_cast<size_t>(n));
      if (!interrupted && result.err.find(options.interrupt_on) != std::string::npos) {
        interrupted = true;
        kill(child, options.signal);
      }
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (result.exit_code == 127) {
    throw std::runtime_error(CommandPath() + " cannot be started");
  }
  return result;
}

}  // namespace bodyloom
