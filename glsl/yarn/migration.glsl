// Fiber migration; twin: src/yarn/migration.rs.
#ifndef WORSTED_MIGRATION
#define WORSTED_MIGRATION

// Distance from the ply's centre as a share of its ellipse, with its derivative by the phase.
// Wu & Yuksel 2019, Eq. 2, with a migration phase m_i of its own for each fiber in place of theta_i
// (as printed, s = 1 would shift every ply sideways). `phase` = s theta + m_i, radians.
vec2 migration_radius(float radius, float phase, float migration_min, float migration_max) {
    float middle = 0.5 * radius * (migration_max + migration_min);
    float swing = 0.5 * radius * (migration_max - migration_min);
    return vec2(middle + swing * cos(phase), -swing * sin(phase));
}

#endif
