#pragma once

#include <memory>

#include <boost/multiprecision/cpp_int.hpp>

namespace corridor::test {

/// An integer of any length; up to 512 bits without allocation.
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked,
                                           std::allocator<boost::multiprecision::limb_type>>,
    boost::multiprecision::et_off>;

}  // namespace corridor::test
