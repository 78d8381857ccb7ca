#include "exitance/lab/laboratory.hpp"
#include "exitance/methods/methods.hpp"

/// The engine has no growing cells until the laboratory is installed.
int main() {
    using namespace exitance;
    const bool has_none = find_method(Method::growing_cells) == nullptr;
    install_laboratory();
    return has_none && find_method(Method::growing_cells) ? 0 : 1;
}
