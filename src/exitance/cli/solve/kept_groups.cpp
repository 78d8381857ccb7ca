#include "exitance/cli/solve/kept_groups.hpp"

namespace exitance {

Error no_light_groups(const std::string& solution_file) {
    return {ErrorCode::usage, "keeps no light groups", solution_file,
            "solve a scene with emitters: exitance solve SCENE --light-groups -o S.h5"};
}

}  // namespace exitance
