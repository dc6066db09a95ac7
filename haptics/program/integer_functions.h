#pragma once
// Integer operations whose result C++ leaves open, each with a fixed one.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace touchstone::program {

inline int32_t asSigned(uint32_t x) {
    return std::bit_cast<int32_t>(x);
}
inline uint32_t asBits(int32_t x) {
    return std::bit_cast<uint32_t>(x);
}

/// Saturates; of a NaN: 0.
inline int32_t toSigned(float x) {
    if (!(x > -2147483648.0f))
        return std::isnan(x) ? 0 : std::numeric_limits<int32_t>::min();
    return x < 2147483648.0f ? static_cast<int32_t>(x) : std::numeric_limits<int32_t>::max();
}
inline uint32_t toUnsigned(float x) {
    if (!(x > 0.0f))
        return 0;
    return x < 4294967296.0f ? static_cast<uint32_t>(x) : std::numeric_limits<uint32_t>::max();
}

/// The divisor is not zero; the smallest number divided by -1 wraps round.
inline uint32_t divideSigned(uint32_t a, uint32_t b) {
    return static_cast<uint32_t>(static_cast<int64_t>(asSigned(a)) / asSigned(b));
}
/// The sign of a.
inline uint32_t remainderSigned(uint32_t a, uint32_t b) {
    return static_cast<uint32_t>(static_cast<int64_t>(asSigned(a)) % asSigned(b));
}
/// The sign of b.
inline uint32_t moduloSigned(uint32_t a, uint32_t b) {
    const int64_t divisor = asSigned(b), rest = asSigned(a) % divisor;
    return static_cast<uint32_t>(rest != 0 && (rest < 0) != (divisor < 0) ? rest + divisor : rest);
}

inline uint32_t maskOf(uint32_t bits) {
    return bits >= 32 ? ~uint32_t{0} : (uint32_t{1} << bits) - 1;
}
/// What lies beyond bit 31 is cut off.
inline uint32_t extractUnsigned(uint32_t base, uint32_t offset, uint32_t bits) {
    return offset >= 32 ? 0 : (base >> offset) & maskOf(bits);
}
inline uint32_t extractSigned(uint32_t base, uint32_t offset, uint32_t bits) {
    if (bits == 0 || offset >= 32)
        return 0;
    const uint32_t width = std::min(bits, 32 - offset), shift = 32 - width;
    return asBits(asSigned(extractUnsigned(base, offset, width) << shift) >> shift);
}
inline uint32_t insertBits(uint32_t base, uint32_t insert, uint32_t offset, uint32_t bits) {
    if (offset >= 32)
        return base;
    const uint32_t mask = maskOf(bits) << offset;
    return (base & ~mask) | ((insert << offset) & mask);
}
inline uint32_t reverseBits(uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}
/// Numbers of bits; -1 where there is none.
inline uint32_t lowestBit(uint32_t x) {
    return x == 0 ? ~uint32_t{0} : static_cast<uint32_t>(std::countr_zero(x));
}
inline uint32_t highestBit(uint32_t x) {
    return 31u - static_cast<uint32_t>(std::countl_zero(x));
}
inline uint32_t highestBitSigned(uint32_t x) {
    return highestBit(asSigned(x) < 0 ? ~x : x);
}
inline uint32_t highProduct(uint32_t a, uint32_t b) {
    return static_cast<uint32_t>((uint64_t{a} * b) >> 32);
}
inline uint32_t highProductSigned(uint32_t a, uint32_t b) {
    return static_cast<uint32_t>((int64_t{asSigned(a)} * asSigned(b)) >> 32);
}

} // namespace touchstone::program
