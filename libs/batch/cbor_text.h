// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace psi_slam {

/// For a wire. Unlike JSON it holds file names of any encoding; Json::from_cbor() takes it.
inline std::string cbor_text(const nlohmann::json& json) {
  std::string text;
  nlohmann::json::to_cbor(json, text);
  return text;
}

}  // namespace psi_slam
