/* The elementary functions below are those of the FreeBSD project's msun by way of musl, as the Rust crate `libm` has
 * them, so that all machines compute the same bits. Their notice:
 *
 * Copyright (C) 1993, 2004 by Sun Microsystems, Inc. All rights reserved.
 *
 * Developed at SunPro, a Sun Microsystems, Inc. business. Permission to use, copy, modify, and distribute this
 * software is freely granted, provided that this notice is preserved.
 *
 * Of musl: Copyright (C) 2005-2020 Rich Felker, et al. Permission is hereby granted, free of charge, to any person
 * obtaining a copy of this software and associated documentation files (the "Software"), to deal in the Software
 * without restriction, including without limitation the rights to use, copy, modify, merge, publish, distribute,
 * sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do so,
 * subject to the following conditions: the above copyright notice and this permission notice shall be included in all
 * copies or substantial portions of the Software. The Software is provided "as is", without warranty of any kind. */
