// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "rawlog/object_source.h"

namespace psi_slam {

/// Reads the objects of an MRPT rawlog file, plain or gzipped, in the order of the file: actions, sensory
/// frames, and those of the observations that psi-slam uses: scans, odometry and gyroscopes.
///
/// MRPT allocates the sizes that objects state, and some damaged objects crash it. Therefore a child process
/// reads the file and sends these objects. It may take 512 MiB more than this process had.
class RawlogArchive : public ObjectSource {
 public:
  /// Starts the child process. Throws SystemFailure if that is impossible.
  explicit RawlogArchive(const std::filesystem::path& path);
  ~RawlogArchive() override;

  /// Returns the next object, or null at the end of the file. Throws UserError if the file cannot be opened,
  /// ends within an object, is damaged, or holds an object that this version of MRPT does not know;
  /// SystemFailure if the child process is killed.
  mrpt::serialization::CSerializable::Ptr next() override;

  std::string place() const override;
  const std::filesystem::path& path() const override;
  double progress() const override;

 private:
  struct State;
  [[noreturn]] void report_death() const;

  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
