// SPDX-License-Identifier: BSD-3-Clause
// Scans that later passes supersede, see mapping/loop_closure/superseded_maps.h. The mapper frees them, but a
// saved session needs them: resuming maps all scans again. They are kept, compressed, in a temporary file, so
// that the memory of a run does not grow with its length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "psi_slam/frame.h"
#include "session/session_content.h"

namespace psi_slam {

class SupersededScans {
 public:
  /// Keeps a scan with its number. Numbers may come in any order. If the file cannot be written, because the
  /// disk is full for example, put_back() throws.
  void add(std::size_t scan, Frame frame);

  bool empty() const { return scans_.empty(); }

  /// Puts the scans back into the frames of all scans. Throws SystemFailure if the file could not be written
  /// or cannot be read.
  void put_back(std::vector<Frame>& frames) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void write_waiting();

  std::vector<std::size_t> scans_;  ///< the number of each scan
  std::vector<Frame> waiting_;      ///< the last scans, which are not in the file yet
  SessionContentWriter writer_;
  std::unique_ptr<std::FILE, Close> file_;  ///< without a name; null before the first scans are written
  std::optional<std::string> failure_;      ///< why the file could not be written
};

}  // namespace psi_slam
