// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

// The conversions of Anything are only declared, never called, so -Wconversion does not apply.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"

namespace psi_slam {
namespace member_count_detail {

/// A placeholder that converts to any type.
struct Anything {
  template <class T>
  operator T() const;
};

template <std::size_t>
using Always = Anything;

template <class Struct, class Indices, class = void>
struct TakesMembers : std::false_type {};

template <class Struct, std::size_t... i>
struct TakesMembers<Struct, std::index_sequence<i...>, std::void_t<decltype(Struct{Always<i>{}...})>>
    : std::true_type {};

template <class Struct, std::size_t count>
constexpr std::size_t counted_from() {
  if constexpr (TakesMembers<Struct, std::make_index_sequence<count + 1>>::value)
    return counted_from<Struct, count + 1>();
  else
    return count;
}

}  // namespace member_count_detail

/// Number of members of an aggregate. A member that is a struct counts as one.
template <class Struct>
constexpr std::size_t member_count() {
  return member_count_detail::counted_from<Struct, 0>();
}

}  // namespace psi_slam

#pragma GCC diagnostic pop
