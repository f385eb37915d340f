// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "compression/byte_source.h"
#include "rawlog/object_source.h"

namespace psi_slam {

/// Reads the objects of an MRPT rawlog, plain or gzipped, in the order of the file.
class RawlogArchive : public ObjectSource {
 public:
  explicit RawlogArchive(const std::filesystem::path& path);
  /// Reads a rawlog that is still being recorded. An object that is incomplete at the end is dropped.
  explicit RawlogArchive(std::unique_ptr<ByteSource> recording);
  ~RawlogArchive() override;

  /// Returns the next object, or null at the end of the file. Throws UserError if the file ends within an
  /// object, is damaged, or holds an object that this version of MRPT does not know.
  mrpt::serialization::CSerializable::Ptr next() override;

  std::string place() const override;
  const std::filesystem::path& path() const override;
  double progress() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
