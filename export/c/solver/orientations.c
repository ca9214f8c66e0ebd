#if GYRO_HAS_PLACES
enum { GYRO_PLACE_ANGLE, GYRO_PLACE_LENGTH, GYRO_PLACE_ORIENTATION, GYRO_PLACE_BODY };

static const unsigned char gyro_places[] = {GYRO_PLACES};

static int gyro_n_coordinates(unsigned char place)
{
    return place == GYRO_PLACE_BODY ? 7 : place == GYRO_PLACE_ORIENTATION ? 4 : 1;
}
#endif

/* Makes unit vectors of all Euler parameters, whose length means nothing: each step ends with this. */
#if GYRO_HAS_ORIENTATIONS
static void gyro_normalise(gyro_real *p)
{
    gyro_real square = K(0.0);
    for (int k = 0; k < 4; k++)
        square = p[k] * p[k] + square;
    const gyro_real scale = K(1.0) / SQRT(square);
    for (int k = 0; k < 4; k++)
        p[k] = p[k] * scale;
}

static void gyro_normalise_orientations(gyro_real *x)
{
    for (int n = 0; n < (int)sizeof gyro_places; n++) {
        if (gyro_places[n] == GYRO_PLACE_ORIENTATION)
            gyro_normalise(x);
        if (gyro_places[n] == GYRO_PLACE_BODY)
            gyro_normalise(x + 3);
        x += gyro_n_coordinates(gyro_places[n]);
    }
}
#else
static void gyro_normalise_orientations(gyro_real *x)
{
    (void)x;
}
#endif
