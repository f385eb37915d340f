// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "logs/rawlog/object_source.h"

namespace psi_slam {

/// Returns what psi-slam uses of an object: an action, scans, odometry, gyroscopes, a sensory frame of these,
/// and of clouds, see is_cloud(), the points as a CObservationPointCloud, or without points if `slices` is
/// false. Null if nothing.
mrpt::serialization::CSerializable::Ptr used_part(const mrpt::serialization::CSerializable::Ptr& object,
                                                  bool slices);

/// Makes MRPT find the external files of log.rawlog in the folder log_Images, or else Images, beside it.
/// Holds for the whole process.
void find_external_files(const std::filesystem::path& path);

/// Reads those objects of an MRPT rawlog file that psi-slam uses, in the order of the file: actions, scans,
/// odometry, gyroscopes, clouds, and sensory frames of these; see used_part(). The file may be compressed.
///
/// MRPT allocates whatever size an object states, and some damaged objects crash it. Therefore a child
/// process reads the file with MRPT and sends the objects. Beyond the memory of this process when it starts,
/// it may take 512 MiB, and for each object 10 s of processor time.
class RawlogArchive : public ObjectSource {
 public:
  /// Starts the child process. Throws SystemFailure if that is impossible.
  explicit RawlogArchive(const std::filesystem::path& path, bool slices = false);
  ~RawlogArchive() override;

  /// Returns the next object, or null at the end of the file. Throws UserError if the file cannot be opened,
  /// ends within an object, is damaged, or holds an object that this version of MRPT does not know, and if
  /// the child process ends; SystemFailure if the system fails. After an error, throws it again.
  mrpt::serialization::CSerializable::Ptr next() override;

  std::string place() const override;
  const std::filesystem::path& path() const override;
  double progress() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
