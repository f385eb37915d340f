// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <memory>
#include <string>

namespace psi_slam {

/// Reads the objects of an MRPT rawlog, plain or gzipped, in the order of the file.
class RawlogArchive {
 public:
  explicit RawlogArchive(const std::filesystem::path& path);
  ~RawlogArchive();

  /// Returns the next object, or null at the end of the file. Throws UserError if the file ends within an
  /// object, is damaged, or holds an object that this version of MRPT does not know.
  mrpt::serialization::CSerializable::Ptr next();

  /// Place of the object that next() last read, for error messages: "path: object 12". Objects are counted
  /// from 1.
  std::string place() const;

  const std::filesystem::path& path() const;
  /// Share of the file read so far, in [0, 1].
  double progress() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
