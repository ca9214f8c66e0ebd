
/* The method of order 8 of Dormand and Prince with estimates of orders 5 and 3 and dense output of order 7, by Hairer,
 * Norsett and Wanner, Solving Ordinary Differential Equations I (2nd ed. 1993), section II.5. */
/* Three more stages of the interpolant. */
static const gyro_stage gyro_dop853_more[3] = {
    {0.1, 8, {0, 6, 7, 8, 9, 10, 11, 12}, {
        0.056167502283047954, 0.25350021021662483, -0.2462390374708025, -0.12419142326381637,
        0.15329179827876568, 0.00820105229563469, 0.007567897660545699, -0.008298
    }},
    {0.2, 8, {0, 5, 6, 7, 10, 11, 12, 13}, {
        0.03183464816350214, 0.028300909672366776, 0.053541988307438566, -0.05492374857139099,
        -0.00010834732869724932, 0.0003825710908356584, -0.00034046500868740456, 0.1413124436746325
    }},
    {0.7777777777777778, 8, {0, 5, 6, 7, 8, 12, 13, 14}, {
        -0.42889630158379194, -4.697621415361164, 7.683421196062599, 4.06898981839711, 0.3567271874552811,
        -0.0013990241651590145, 2.9475147891527724, -9.15095847217987
    }}
};

/* The interpolant's coefficients from the fourth on. */
static const gyro_stage gyro_dop853_sums[4] = {
    {0.0, 12, {0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {
        -8.428938276109013, 0.5667149535193777, -3.0689499459498917, 2.38466765651207, 2.117034582445028,
        -0.871391583777973, 2.2404374302607883, 0.6315787787694688, -0.08899033645133331, 18.148505520854727,
        -9.194632392478356, -4.436036387594894
    }},
    {0.0, 12, {0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {
        10.427508642579134, 242.28349177525817, 165.20045171727028, -374.5467547226902, -22.113666853125306,
        7.733432668472264, -30.674084731089398, -9.332130526430229, 15.697238121770845, -31.139403219565178,
        -9.35292435884448, 35.81684148639408
    }},
    {0.0, 12, {0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {
        19.985053242002433, -387.0373087493518, -189.17813819516758, 527.8081592054236, -11.57390253995963,
        6.8812326946963, -1.0006050966910838, 0.7777137798053443, -2.778205752353508, -60.19669523126412,
        84.32040550667716, 11.99229113618279
    }},
    {0.0, 12, {0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {
        -25.69393346270375, -154.18974869023643, -231.5293791760455, 357.6391179106141, 93.40532418362432,
        -37.45832313645163, 104.0996495089623, 29.8402934266605, -43.53345659001114, 96.32455395918828,
        -39.17726167561544, -149.72683625798564
    }}
};

static void gyro_dop853_attempt(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y,
    int resumes)
{
    if (!resumes) {
        gyro_slope(s, m, t, y, s->k[0]);
        if (s->is_carried) {
            /* The twelfth slope of the last step belongs to the same time. */
            gyro_rate(s->rate, s->k[0], s->k[11], y, s->stage);
            s->is_carried = 0;
        }
    }
    STAGE(s->stage, AT(0, 0.05260015195876773));
    gyro_slope(s, m, t + K(0.05260015195876773) * h, s->stage, s->k[1]);
    STAGE(s->stage, AT(0, 0.0197250569845379) + AT(1, 0.0591751709536137));
    gyro_slope(s, m, t + K(0.0789002279381516) * h, s->stage, s->k[2]);
    STAGE(s->stage, AT(0, 0.02958758547680685) + AT(2, 0.08876275643042054));
    gyro_slope(s, m, t + K(0.1183503419072274) * h, s->stage, s->k[3]);
    STAGE(s->stage, AT(0, 0.2413651341592667) + AT(2, -0.8845494793282861) + AT(3, 0.924834003261792));
    gyro_slope(s, m, t + K(0.2816496580927726) * h, s->stage, s->k[4]);
    STAGE(s->stage, AT(0, 0.037037037037037035) + AT(3, 0.17082860872947386) + AT(4, 0.12546768756682242));
    gyro_slope(s, m, t + K(0.3333333333333333) * h, s->stage, s->k[5]);
    STAGE(s->stage, AT(0, 0.037109375) + AT(3, 0.17025221101954405) + AT(4, 0.06021653898045596)
        + AT(5, -0.017578125));
    gyro_slope(s, m, t + K(0.25) * h, s->stage, s->k[6]);
    STAGE(s->stage, AT(0, 0.03709200011850479) + AT(3, 0.17038392571223998) + AT(4, 0.10726203044637328)
        + AT(5, -0.015319437748624402) + AT(6, 0.008273789163814023));
    gyro_slope(s, m, t + K(0.3076923076923077) * h, s->stage, s->k[7]);
    STAGE(s->stage, AT(0, 0.6241109587160757) + AT(3, -3.3608926294469414) + AT(4, -0.868219346841726)
        + AT(5, 27.59209969944671) + AT(6, 20.154067550477894) + AT(7, -43.48988418106996));
    gyro_slope(s, m, t + K(0.6512820512820513) * h, s->stage, s->k[8]);
    STAGE(s->stage, AT(0, 0.47766253643826434) + AT(3, -2.4881146199716677) + AT(4, -0.590290826836843)
        + AT(5, 21.230051448181193) + AT(6, 15.279233632882423) + AT(7, -33.28821096898486)
        + AT(8, -0.020331201708508627));
    gyro_slope(s, m, t + K(0.6) * h, s->stage, s->k[9]);
    STAGE(s->stage, AT(0, -0.9371424300859873) + AT(3, 5.186372428844064) + AT(4, 1.0914373489967295)
        + AT(5, -8.149787010746927) + AT(6, -18.52006565999696) + AT(7, 22.739487099350505)
        + AT(8, 2.4936055526796523) + AT(9, -3.0467644718982196));
    gyro_slope(s, m, t + K(0.8571428571428571) * h, s->stage, s->k[10]);
    STAGE(s->stage, AT(0, 2.273310147516538) + AT(3, -10.53449546673725) + AT(4, -2.0008720582248625)
        + AT(5, -17.9589318631188) + AT(6, 27.94888452941996) + AT(7, -2.8589982771350235)
        + AT(8, -8.87285693353063) + AT(9, 12.360567175794303) + AT(10, 0.6433927460157636));
    gyro_slope(s, m, t + K(1.0) * h, s->stage, s->k[11]);
    STAGE(s->end, AT(0, 0.054293734116568765) + AT(5, 4.450312892752409) + AT(6, 1.8915178993145003)
        + AT(7, -5.801203960010585) + AT(8, 0.3111643669578199) + AT(9, -0.1521609496625161)
        + AT(10, 0.20136540080403034) + AT(11, 0.04471061572777259));
    gyro_normalise_orientations(s->end);
}

static void gyro_dop853_prepare(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y)
{
    gyro_real *stage = s->dense[0];
    gyro_slope(s, m, t + K(1.0) * h, s->end, s->k[12]);
    for (int n = 0; n < 3; n++) {
        gyro_combine(stage, y, h, &gyro_dop853_more[n], s->k);
        gyro_slope(s, m, t + K(gyro_dop853_more[n].c) * h, stage, s->k[n + 13]);
    }
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real change = s->end[i] - y[i];
        const gyro_real from = h * s->k[0][i], to = h * s->k[12][i];
        s->dense[0][i] = y[i];
        s->dense[1][i] = change;
        s->dense[2][i] = from - change;
        s->dense[3][i] = change + change - (to + from);
        for (int n = 0; n < 4; n++)
            s->dense[n + 4][i] = h * gyro_sum(&gyro_dop853_sums[n], s->k, i);
    }
}

static void gyro_dop853_between(const gyro_solver *s, gyro_real theta, gyro_real *out)
{
    const gyro_real rest = K(1.0) - theta;
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        gyro_real sum = s->dense[7][i];
        for (int n = 6; n >= 0; n--)
            sum = (n % 2 == 0 ? theta : rest) * sum + s->dense[n][i];
        out[i] = sum;
    }
}

static gyro_real gyro_dop853_error(gyro_solver *s, gyro_real h, int *worst)
{
    gyro_real five = K(0.0), three = K(0.0), largest = K(0.0);
    *worst = 0;
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real of_five = AT(0, 0.01312004499419488) + AT(5, -1.2251564463762044)
            + AT(6, -0.4957589496572502) + AT(7, 1.6643771824549864) + AT(8, -0.35032884874997366)
            + AT(9, 0.3341791187130175) + AT(10, 0.08192320648511571) + AT(11, -0.022355307863886294);
        const gyro_real of_three = AT(0, -0.18980075407240762) + AT(5, 4.450312892752409)
            + AT(6, 1.8915178993145003) + AT(7, -5.801203960010585) + AT(8, -0.42268232132379197)
            + AT(9, -0.1521609496625161) + AT(10, 0.20136540080403034) + AT(11, 0.022651792198360825);
        const gyro_real e5 = of_five / s->weights[i], e3 = of_three / s->weights[i];
        if (!(isfinite(e5) && isfinite(e3))) {
            *worst = i;
            return K(INFINITY);
        }
        five = e5 * e5 + five;
        three = e3 * e3 + three;
        if (FABS(e5) > largest) {
            largest = FABS(e5);
            *worst = i;
        }
    }
    const gyro_real both = (five + three * K(0.01)) * K(GYRO_SOLVER_N);
    return both > K(0.0) ? h * (five / SQRT(both)) : K(0.0);
}
