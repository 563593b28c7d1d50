// Report data from the standard input, the page to the standard output: for the tests of the page.
#include <iostream>
#include <iterator>
#include <string>

#include "tools/bench_page.h"

int main() {
    const std::string data{std::istreambuf_iterator<char>(std::cin),
                           std::istreambuf_iterator<char>()};
    std::cout << etendue::benchPage(data);
    return std::cout.flush() ? 0 : 1;
}
