// Compiled for registers of 64 bytes and called where the processor has them.
#include "lens/polynomial_batch_kernel.h"

namespace etendue {

template <class T, int Size, int Inputs>
void evaluateWide(const BatchTask<T>& task) {
    evaluateInRegisters<64, T, Size, Inputs>(task);
}

#define ETENDUE_INSTANTIATE(T, Size)                             \
    template void evaluateWide<T, Size, 0>(const BatchTask<T>&); \
    template void evaluateWide<T, Size, 2>(const BatchTask<T>&); \
    template void evaluateWide<T, Size, 4>(const BatchTask<T>&);
ETENDUE_INSTANTIATE(float, 8)
ETENDUE_INSTANTIATE(float, 16)
ETENDUE_INSTANTIATE(double, 8)
ETENDUE_INSTANTIATE(double, 16)

}  // namespace etendue
