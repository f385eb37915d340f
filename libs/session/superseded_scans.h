// SPDX-License-Identifier: BSD-3-Clause
// Scans that later passes supersede, see mapping/loop_closure/superseded_maps.h. The mapper frees them, but a
// saved session and the corrected log need them. While a run maps, they are kept, compressed, in a temporary
// file. Saving and exporting bring all of them back into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "psi_slam/frame.h"
#include "session/session_content.h"

namespace psi_slam {

class SupersededScans {
 public:
  /// Keeps a scan with its number. Numbers may come in any order. What cannot be written, because the disk is
  /// full for example, stays in memory.
  void add(std::size_t scan, Frame frame);

  bool empty() const { return scans_.empty(); }

  /// Puts the scans back into the frames of all scans. Throws SystemFailure if the file cannot be read.
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
  std::size_t file_bytes_ = 0;              ///< bytes of the file that are whole parts
  bool is_full_ = false;                    ///< whether a part could not be written
};

}  // namespace psi_slam
