// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "compression/byte_source.h"
#include "rawlog/object_source.h"

namespace psi_slam {

/// Makes MRPT know the classes of all observations in logs, although psi-slam refers to few of these.
void register_rawlog_classes();

/// Reads the objects of an MRPT rawlog in this process. MRPT trusts the sizes that objects state, and some
/// damaged objects crash it; so RawlogArchive reads files.
class RawlogStream : public ObjectSource {
 public:
  /// With `is_growing`, the rawlog is still being recorded, and an object that is incomplete at the end is
  /// dropped.
  RawlogStream(std::unique_ptr<ByteSource> bytes, bool is_growing);
  ~RawlogStream() override;

  /// Returns the next object, or null at the end of the file. Throws UserError if the file ends within an
  /// object, is damaged, or holds an object that this version of MRPT does not know; std::bad_alloc if an
  /// object needs more memory than there is.
  mrpt::serialization::CSerializable::Ptr next() override;

  /// Number of objects that next() has read, and the one that it is reading.
  std::size_t count() const;
  std::string place() const override;
  const std::filesystem::path& path() const override;
  double progress() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
