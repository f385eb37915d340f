// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"
#include "session/edit_journal.h"

/// Parses a file of edits. What is accepted must be written and parsed again to the same text.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] {
    const std::string text = EditJournal::parse(std::string(fuzz::text_of(data, size)), "input.edits").text();
    if (EditJournal::parse(text, "again.edits").text() != text) std::abort();
  });
  return 0;
}
