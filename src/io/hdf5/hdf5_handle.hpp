#pragma once

// Owners of HDF5 handles.

#include "base/check.hpp"

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>

namespace gcpdda::hdf5 {

/// Owner of one HDF5 identifier.
template <herr_t (*Close)(hid_t)> class Handle {
public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  ~Handle() { close(); }
  Handle(Handle &&other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle &operator=(Handle &&other) noexcept {
    if (this != &other) {
      close();
      id_ = std::exchange(other.id_, -1);
    }
    return *this;
  }
  [[nodiscard]] hid_t get() const { return id_; }
  /// True when HDF5 agreed to close, or when nothing was open.
  bool close() { return id_ < 0 || Close(std::exchange(id_, -1)) >= 0; }

private:
  hid_t id_ = -1;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Object = Handle<H5Oclose>;
using Dataset = Handle<H5Dclose>;
using Dataspace = Handle<H5Sclose>;
using Datatype = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

/// While one lives, HDF5 keeps its error stack to itself.
class QuietErrors {
public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietErrors(const QuietErrors &) = delete;
  QuietErrors &operator=(const QuietErrors &) = delete;

private:
  H5E_auto2_t function_ = nullptr;
  void *data_ = nullptr;
};

/// What HDF5 says of the last failed call, where it was detected.
inline std::string last_error() {
  std::string message;
  const auto take_first = [](unsigned n, const H5E_error2_t *error, void *text) -> herr_t {
    if (n == 0 && error->desc != nullptr) {
      *static_cast<std::string *>(text) = error->desc;
    }
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &message);
  return message.empty() ? "HDF5 gives no reason" : message;
}

/// The return value of an HDF5 call, or FileError: "cannot <what>: <reason>".
template <class Value> Value checked(Value value, const std::string &what) {
  if (value < 0) {
    throw FileError("cannot " + what + ": " + last_error());
  }
  return value;
}

/// How a C++ number is held in memory and, whatever the machine, in the file.
template <class T> struct NumberType;
template <> struct NumberType<double> {
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static hid_t file() { return H5T_IEEE_F64LE; }
};
template <> struct NumberType<std::int64_t> {
  static hid_t memory() { return H5T_NATIVE_INT64; }
  static hid_t file() { return H5T_STD_I64LE; }
};
template <> struct NumberType<std::int32_t> {
  static hid_t memory() { return H5T_NATIVE_INT32; }
  static hid_t file() { return H5T_STD_I32LE; }
};
template <> struct NumberType<std::uint8_t> {
  static hid_t memory() { return H5T_NATIVE_UINT8; }
  static hid_t file() { return H5T_STD_U8LE; }
};

} // namespace gcpdda::hdf5
