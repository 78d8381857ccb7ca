#include "exitance/lab/laboratory.hpp"

#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/lab/growing_cells/cells_group.hpp"

namespace exitance {

void install_laboratory() {
    install_lab_methods();
    add_light_form_group({"growing_cells", write_cells, read_cells});
}

}  // namespace exitance
