#include "assets/lettering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace touchstone::assets {

namespace {

constexpr int kColumns = 5, kRows = 7;
using Glyph = std::array<uint8_t, kRows>; ///< rows from the top, bit 4 is the leftmost dot

constexpr std::array<Glyph, 26> kLetters{{
    {0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001}, // A
    {0b11110, 0b10001, 0b10001, 0b11110, 0b10001, 0b10001, 0b11110}, // B
    {0b01110, 0b10001, 0b10000, 0b10000, 0b10000, 0b10001, 0b01110}, // C
    {0b11110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b11110}, // D
    {0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111}, // E
    {0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b10000}, // F
    {0b01110, 0b10001, 0b10000, 0b10111, 0b10001, 0b10001, 0b01110}, // G
    {0b10001, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001}, // H
    {0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}, // I
    {0b00111, 0b00010, 0b00010, 0b00010, 0b00010, 0b10010, 0b01100}, // J
    {0b10001, 0b10010, 0b10100, 0b11000, 0b10100, 0b10010, 0b10001}, // K
    {0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111}, // L
    {0b10001, 0b11011, 0b10101, 0b10101, 0b10001, 0b10001, 0b10001}, // M
    {0b10001, 0b11001, 0b10101, 0b10011, 0b10001, 0b10001, 0b10001}, // N
    {0b01110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110}, // O
    {0b11110, 0b10001, 0b10001, 0b11110, 0b10000, 0b10000, 0b10000}, // P
    {0b01110, 0b10001, 0b10001, 0b10001, 0b10101, 0b10010, 0b01101}, // Q
    {0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001}, // R
    {0b01111, 0b10000, 0b10000, 0b01110, 0b00001, 0b00001, 0b11110}, // S
    {0b11111, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100}, // T
    {0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110}, // U
    {0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01010, 0b00100}, // V
    {0b10001, 0b10001, 0b10001, 0b10101, 0b10101, 0b11011, 0b10001}, // W
    {0b10001, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001, 0b10001}, // X
    {0b10001, 0b10001, 0b01010, 0b00100, 0b00100, 0b00100, 0b00100}, // Y
    {0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b10000, 0b11111}, // Z
}};

} // namespace

bool inked(std::string_view text, double u, double v) {
    // One dot between letters. Eight letters take 80 % of the square's width; longer texts are smaller.
    const double dots = static_cast<double>(text.size()) * (kColumns + 1) - 1;
    const double dot = 0.8 / std::max(dots, 8.0 * (kColumns + 1) - 1);
    const double x = (u - 0.5) / dot + 0.5 * dots, y = (v - 0.5) / dot + 0.5 * kRows;
    if (x < 0.0 || y < 0.0 || x >= dots || y >= kRows)
        return false;
    const auto letter = static_cast<size_t>(x / (kColumns + 1));
    const int column = static_cast<int>(x) - static_cast<int>(letter) * (kColumns + 1);
    if (column >= kColumns || text[letter] < 'A' || text[letter] > 'Z')
        return false;
    const Glyph& glyph = kLetters[static_cast<size_t>(text[letter] - 'A')];
    return (glyph[static_cast<size_t>(y)] >> (kColumns - 1 - column) & 1) != 0;
}

} // namespace touchstone::assets
