// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <memory>
#include <string>

namespace psi_slam {

/// Reads the objects of an MRPT rawlog in order, plain or gzipped.
class RawlogArchive {
 public:
  explicit RawlogArchive(const std::filesystem::path& path);
  ~RawlogArchive();

  /// Returns the next object, or null at the end. Throws UserError if the file ends within an object, is
  /// damaged, or holds an object that this version of MRPT does not know.
  mrpt::serialization::CSerializable::Ptr next();

  /// Place of the last object for messages, counted from 1: "path: object 12".
  std::string place() const;

  const std::filesystem::path& path() const;
  double progress() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
