// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <string>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Actions, sensory frames and observations of MRPT in their order: those of a rawlog, or of sensors that are
/// read.
class ObjectSource {
 public:
  virtual ~ObjectSource() = default;

  /// Returns the next object, or null at the end. Sensors wait for their next observation.
  virtual mrpt::serialization::CSerializable::Ptr next() = 0;

  /// Place of the object that next() last returned, for error messages: "path: object 12". Objects are
  /// counted from 1.
  virtual std::string place() const = 0;

  /// Objects that were dropped because next() was not called fast enough.
  virtual SkippedLines dropped() const { return {}; }

  virtual const std::filesystem::path& path() const = 0;
  /// Share of the objects read so far, in [0, 1]; 0 for sensors.
  virtual double progress() const = 0;
};

}  // namespace psi_slam
