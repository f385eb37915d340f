// SPDX-License-Identifier: BSD-3-Clause
// Programs run to their ends, several at a time: by threads of this one, or by whoever takes the words and
// gives the end back as texts.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/child_process.h"

namespace psi_slam {

/// A program with its path, and its arguments.
using ChildWords = std::vector<std::string>;

/// What workers tell and ask; by several threads where they are threads, each about programs of its own.
struct ChildWatch {
  std::function<bool()> stop;                                 ///< once true, no more are begun
  std::function<void(std::size_t child)> working;             ///< a few times a second
  std::function<void(std::size_t child, ChildEnd)> finished;  ///< once for each that was not stopped
};

/// Each of them by run_to_end().
using ChildWorkers = std::function<void(const std::vector<ChildWords>&, const ChildWatch&)>;

/// So many at a time on this machine.
ChildWorkers local_child_workers(int processes);

/// As run_child(), but one that cannot be started has failed with that as its last words; none where `stop`
/// ended it.
std::optional<ChildEnd> run_to_end(const ChildWords& words, const std::function<bool()>& stop);

/// For a wire; read_*() take what these made.
std::string child_words_text(const ChildWords& words);
ChildWords read_child_words(const std::string& text);
std::string child_end_text(const ChildEnd& end);
ChildEnd read_child_end(const std::string& text);

}  // namespace psi_slam
