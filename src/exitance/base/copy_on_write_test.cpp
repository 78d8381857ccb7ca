#include "exitance/base/copy_on_write.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {
namespace {

TEST(CopyOnWrite, CopiesShareUntilOneIsChanged) {
    CopyOnWrite<std::vector<int>> a;
    a.change() = {1, 2, 3};
    CopyOnWrite<std::vector<int>> b = a;
    EXPECT_EQ(a->data(), b->data());
    b.change().push_back(4);
    EXPECT_EQ(a->size(), 3u);
    EXPECT_EQ(b->size(), 4u);
}

TEST(CopyOnWrite, AnUnsharedValueIsChangedInPlace) {
    CopyOnWrite<std::vector<int>> a;
    a.change() = {1, 2, 3};
    const int* const before = a->data();
    a.change()[0] = 7;
    EXPECT_EQ(a->data(), before);
    EXPECT_EQ((*a)[0], 7);
}

}  // namespace
}  // namespace exitance
