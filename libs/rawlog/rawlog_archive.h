// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace psi_slam {

/// The objects of an MRPT rawlog one after the other, plain or gzipped.
class RawlogArchive {
 public:
  explicit RawlogArchive(const std::filesystem::path& path);
  ~RawlogArchive();

  /// The next object, or none at the end. Throws UserError when the file ends within an object, is damaged or
  /// has an object that this MRPT does not know.
  mrpt::serialization::CSerializable::Ptr next();

  /// "path: object 12" of the object last read, counted from 1.
  std::string place() const;

  const std::filesystem::path& path() const;
  double progress() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
