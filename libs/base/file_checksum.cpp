// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_checksum.h"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <map>
#include <memory>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Computes the SHA-256 checksum of bytes that are added piece by piece.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void add(std::string_view bytes) {
    require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }

  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    std::string text;
    for (unsigned i = 0; i < size; ++i)
      for (const unsigned digit : {digest[i] / 16U, digest[i] % 16U}) text += "0123456789abcdef"[digit];
    return text;
  }

 private:
  static void require(bool done) {
    if (!done) throw SystemFailure("OpenSSL cannot compute a SHA-256 checksum");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_of_text(std::string_view text) {
  Sha256 checksum;
  checksum.add(text);
  return checksum.hexadecimal();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  Sha256 checksum;
  std::array<char, 1 << 16> block{};
  while (file.read(block.data(), block.size()) || file.gcount() > 0)
    checksum.add({block.data(), static_cast<std::size_t>(file.gcount())});
  if (!file.eof())
    throw UserError(path.string() +
                    " is not readable. Check that it is a file with read permission, and check the disk");
  return checksum.hexadecimal();
}

std::string sha256_of_log(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return sha256_of_file(path);
  std::map<std::string, std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files[entry.path().lexically_relative(path).string()] = entry.path();
  std::string text;
  for (const auto& [name, file] : files) text += name + ' ' + sha256_of_file(file) + '\n';
  return sha256_of_text(text);
}

}  // namespace psi_slam
