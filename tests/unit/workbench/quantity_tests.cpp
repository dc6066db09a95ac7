// Numbers for people.

#include "workbench/figures/quantity.h"

#include <gtest/gtest.h>

#include <limits>

namespace touchstone::test::quantity_tests {
namespace {

TEST(Quantity, HasThousandsAndNoExponent) {
    EXPECT_EQ(quantity(2000.0, "N/m"), "2,000 N/m");
    EXPECT_EQ(quantity(1234567.0, "N/m"), "1,234,567 N/m") << "whole digits are not rounded away";
    EXPECT_EQ(quantity(99999.9, "N/m"), "100,000 N/m");
    EXPECT_EQ(quantity(-12345.0, "N/m"), "-12,345 N/m");
    EXPECT_EQ(quantity(999.0, "N/m"), "999 N/m");
    EXPECT_EQ(quantity(0.35, ""), "0.35");
    EXPECT_EQ(quantity(1.0, "x"), "1x");
    EXPECT_EQ(quantity(28.4, "°"), "28.4°");
}

TEST(Quantity, HasTheUnitOfItsMagnitude) {
    EXPECT_EQ(quantity(0.0005, "m"), "500 µm");
    EXPECT_EQ(quantity(0.05, "m"), "50 mm");
    EXPECT_EQ(quantity(-0.0012, "m"), "-1.2 mm");
    EXPECT_EQ(quantity(0.0009999, "m"), "1 mm") << "not 1,000 µm";
    EXPECT_EQ(quantity(1.1e-5, "s"), "11 µs");
    EXPECT_EQ(quantity(0.001, "s"), "1 ms");
    EXPECT_EQ(quantity(0.62, "N"), "0.62 N");
    EXPECT_EQ(quantity(0.00023, "N"), "0.23 mN");
    EXPECT_EQ(quantity(0.0, "m"), "0 mm");
}

TEST(Quantity, OfOneScaleHasOneUnit) {
    const ShownUnit unit = shownUnit(0.0012, "m");
    EXPECT_EQ(quantity(0.0, unit), "0 mm");
    EXPECT_EQ(quantity(0.0006, unit), "0.6 mm") << "not 600 µm beside 1.2 mm";
    EXPECT_EQ(quantity(0.0012, unit), "1.2 mm");
}

TEST(Quantity, OfWhatIsNoNumberOrAbsurdIsShort) {
    EXPECT_EQ(figure(std::numeric_limits<double>::infinity()), "inf");
    EXPECT_EQ(figure(std::numeric_limits<double>::quiet_NaN()), "nan");
    EXPECT_EQ(figure(3e38), "3e+38");
    EXPECT_EQ(figure(1e-30), "0");
    EXPECT_EQ(figure(-1e-30), "0");
}

} // namespace
} // namespace touchstone::test::quantity_tests
