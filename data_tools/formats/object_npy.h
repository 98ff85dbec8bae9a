// SPDX-License-Identifier: Apache-2.0
/// .npy arrays of Python objects (dtype object), whose values are one pickle, read by the inert machine of pickle.h.
/// Source: numpy/lib/format.py.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/pickle.h"

namespace bodyloom {

/// Returns true if the bytes are a .npy of Python objects.
bool IsObjectNpy(std::string_view bytes);

/// Returns the object of an array of one (shape () or 1), else the list of them. Throws std::runtime_error naming
/// `where`, as ReadPickle().
PicklePtr ReadObjectNpy(std::string_view bytes, const std::string& where);

/// Returns the member `name` of an .npz of these bytes, which ReadNpzBytes() keeps without its contents. Throws
/// std::runtime_error naming `where` if there is none.
PicklePtr ReadObjectOfNpz(const std::string& bytes, const std::string& name, const std::string& where);

/// Returns the number or text of an array of one object as an array of shape (); nullopt if it is anything else or has
/// more than 64 KiB.
std::optional<NdArray> ScalarOfObjectNpy(std::string_view bytes);

/// Returns a value that is a number as such, NaN for anything else.
double NumberOf(const PickleValue* value);

}  // namespace bodyloom
