extern "C" double sum_below(unsigned count);

int main() {
    return sum_below(1000) == 499500 ? 0 : 1;
}
