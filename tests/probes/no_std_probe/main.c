/* Links the probe and prints alpha after one second, with digits enough to read it back. */
#include <stdio.h>

double gyroscope_alpha(unsigned intervals);

int main(void) {
    printf("%.17g\n", gyroscope_alpha(2000));
    return 0;
}
