// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/compression/byte_source.h"
#include "logs/rawlog/object_source.h"

namespace psi_slam {

/// Registers the classes of all observations in rawlogs with MRPT, also those that psi-slam does not use, so
/// that MRPT can read them. Thread-safe.
void register_rawlog_classes();

/// Reads the objects of an MRPT rawlog in this process. MRPT trusts the sizes that objects state, and some
/// damaged objects crash it. RawlogArchive reads files without these dangers.
class RawlogStream : public ObjectSource {
 public:
  /// With `is_growing`, the rawlog is still being recorded, and an object that is incomplete at the end is
  /// dropped.
  RawlogStream(std::unique_ptr<ByteSource> bytes, bool is_growing);
  ~RawlogStream() override;

  /// Returns the next object, or null at the end of the file. Throws UserError if the file ends within an
  /// object, is damaged, or holds an object that this version of MRPT does not know. If an object needs more
  /// memory than there is, throws std::bad_alloc, or UserError if the rawlog is growing; but some failed
  /// allocations crash MRPT.
  mrpt::serialization::CSerializable::Ptr next() override;

  std::string place() const override;
  const std::filesystem::path& path() const override;
  double progress() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
