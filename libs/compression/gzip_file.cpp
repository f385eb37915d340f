// SPDX-License-Identifier: BSD-3-Clause
#include "compression/gzip_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "psi_slam/user_error.h"

namespace psi_slam {

std::string gzipped(const void* bytes, std::size_t count) {
  constexpr int kGzipWindow = 15 + 16;
  constexpr int kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw SystemFailure("cannot compress a map: out of memory");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);

  std::string result;
  std::array<char, 65536> buffer{};
  stream.next_in =
      static_cast<Bytef*>(const_cast<void*>(bytes));  // zlib reads only; its C interface says otherwise
  int status = Z_OK;
  while (status != Z_STREAM_END) {
    if (stream.avail_in == 0) {
      stream.avail_in = static_cast<uInt>(std::min<std::size_t>(count, std::numeric_limits<uInt>::max()));
      count -= stream.avail_in;
    }
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    status = deflate(&stream, count == 0 ? Z_FINISH : Z_NO_FLUSH);
    result.append(buffer.data(), buffer.size() - stream.avail_out);
  }
  return result;
}

}  // namespace psi_slam
