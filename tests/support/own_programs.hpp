#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "exitance/io/files/atomic_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {

/// Tests that install programs of their own under the names of others, first in PATH.
class OwnPrograms : public testing::Test {
  protected:
    void SetUp() override {
        path_ = std::getenv("PATH");
        ::setenv("PATH", (std::string(folder_ / ".") + ":" + path_).c_str(), 1);
    }
    void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }
    void make(const std::string& name, const std::string& script) {
        ASSERT_TRUE(write_file(folder_ / name, "#!/bin/sh\n" + script));
        std::filesystem::permissions(std::string(folder_ / name), std::filesystem::perms::owner_all);
    }

    TemporaryFolder folder_;
    std::string path_;
};

}  // namespace exitance
