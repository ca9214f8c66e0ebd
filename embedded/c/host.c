/* What the example needs of a machine with an operating system. */
#include <stdio.h>

void print(const char *text) {
    fputs(text, stdout);
}
