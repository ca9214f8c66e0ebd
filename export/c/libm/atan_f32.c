static const float atanf_atanhi[] = {
  4.6364760399e-01,
  7.8539812565e-01,
  9.8279368877e-01,
  1.5707962513e+00,
};

static const float atanf_atanlo[] = {
  5.0121582440e-09,
  3.7748947079e-08,
  3.4473217170e-08,
  7.5497894159e-08,
};

static const float atanf_aT[] = {
  3.3333328366e-01,
 -1.9999158382e-01,
  1.4253635705e-01,
 -1.0648017377e-01,
  6.1687607318e-02,
};

static float libm_atanf(float x)
{
    float w,s1,s2,z;
    uint32_t ix,sign;
    int id;

    GET_FLOAT_WORD(ix, x);
    sign = ix>>31;
    ix &= 0x7fffffff;
    if (ix >= 0x4c800000) {
        if (isnan(x))
            return x;
        z = atanf_atanhi[3] + 0x1p-120f;
        return sign ? -z : z;
    }
    if (ix < 0x3ee00000) {
        if (ix < 0x39800000) {
            return x;
        }
        id = -1;
    } else {
        x = fabsf(x);
        if (ix < 0x3f980000) {
            if (ix < 0x3f300000) {
                id = 0;
                x = (2.0f*x - 1.0f)/(2.0f + x);
            } else {
                id = 1;
                x = (x - 1.0f)/(x + 1.0f);
            }
        } else {
            if (ix < 0x401c0000) {
                id = 2;
                x = (x - 1.5f)/(1.0f + 1.5f*x);
            } else {
                id = 3;
                x = -1.0f/x;
            }
        }
    }

    z = x*x;
    w = z*z;

    s1 = z*(atanf_aT[0]+w*(atanf_aT[2]+w*atanf_aT[4]));
    s2 = w*(atanf_aT[1]+w*atanf_aT[3]);
    if (id < 0)
        return x - x*(s1+s2);
    z = atanf_atanhi[id] - ((x*(s1+s2) - atanf_atanlo[id]) - x);
    return sign ? -z : z;
}
