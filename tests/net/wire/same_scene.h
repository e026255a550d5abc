// Two scenes compared field by field.
#pragma once

#include "scenes/scene.h"

namespace slosh::test {

/// Every field equal bitwise; tells gtest where not.
void expect_same_scene(const Scene& a, const Scene& b);

}  // namespace slosh::test
