// SPDX-License-Identifier: Apache-2.0
/// Checks the contract for unusable files: std::runtime_error with one line that names the file.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace bodyloom {

/// Runs `action`; returns the message of the std::runtime_error it throws, or fails the test. The message must name
/// `where` and be one line.
template <typename Action>
std::string FileErrorOf(const std::string& where, const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    std::string message = error.what();
    EXPECT_NE(message.find(where), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "expected std::runtime_error, got: " << error.what();
    return "";
  }
  ADD_FAILURE() << "expected std::runtime_error, nothing was thrown";
  return "";
}

}  // namespace bodyloom
