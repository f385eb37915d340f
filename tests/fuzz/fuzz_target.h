// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets share. A target is a file NAME_fuzz.cpp that defines LLVMFuzzerTestOneInput(), which
// libFuzzer (https://llvm.org/docs/LibFuzzer.html) calls with mutated bytes. Each target gives them to one
// reader. The reader must accept them or throw UserError; any other exception ends the target.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/byte_cursor.h"
#include "psi_slam/user_error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace psi_slam::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Folder of this process in memory, if the system has such folders.
inline const std::filesystem::path& folder() {
  static const std::filesystem::path kFolder = [] {
    namespace fs = std::filesystem;
    const fs::path parent = fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
    fs::path folder = parent / ("psi-slam-fuzz-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    std::atexit([] { fs::remove_all(kFolder); });
    return folder;
  }();
  return kFolder;
}

inline std::filesystem::path file_with(const std::string& name, std::string_view bytes) {
  std::filesystem::path path = folder() / name;
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

/// Runs a reader. Ends the program if it throws a UserError without a sentence.
template <class Read>
void accept_or_refuse(const Read& read) {
  try {
    read();
  } catch (const UserError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
}

/// Reads frames to the end, but at most 10,000.
template <class Source>
void read_frames(Source&& source) {
  for (int i = 0; i < 10'000 && source.next(); ++i) continue;
  (void)source.skipped_lines().sentence();
  (void)source.assumptions();
}

}  // namespace psi_slam::fuzz
