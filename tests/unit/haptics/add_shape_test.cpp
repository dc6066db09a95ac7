// What addShape refuses.

#include "engine/core/error.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <memory>

namespace touchstone::test::add_shape_test {
namespace {

TEST(AddShape, RefusesWhatHasNoSizeOrNoMaterialOrComesLate) {
    const std::shared_ptr<const Shape> field = fieldOf(ball, 24);
    const FieldBench bench(field);
    const std::shared_ptr<HapticScene> scene = copyOf(*bench.scene);
    const int next = static_cast<int>(scene->objects.size());
    EXPECT_THROW(addShape(*scene, "none", nullptr, 0, {}), Error);
    EXPECT_THROW(addShape(*scene, "material", field, 1, {}), Error);
    EXPECT_EQ(addShape(*scene, "ball", field, 0, {}), next);
    scene->buildNeighbourhoods();
    EXPECT_THROW(addShape(*scene, "late", field, 0, {}), Error);
}

} // namespace
} // namespace touchstone::test::add_shape_test
