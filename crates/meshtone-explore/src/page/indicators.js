// Which of a wheel's many indicators are seen at first.

const byId = (id) => document.getElementById(id);
/** Seen at first, of those that moved. */
const SEEN = 10;
/** Seen at first where there is nothing to compare with. */
const USUAL = ["average_rms", "average_kurtosis", "difference_rms", "difference_kurtosis", "fm0", "fm4", "m6a", "na4", "sideband_level_factor", "mesh_harmonic_1"];

/** Without a size of their own in a healthy pair, so that a ratio says nothing: near 0, of either sign. */
const WITHOUT_RATIO = /sideband_(minus|plus)|skewness/;

/** How far an indicator is from another, up or down alike. */
const moved = (value, other) => {
  const ratio = Math.abs(value / other);
  return Number.isFinite(ratio) && ratio > 0 ? Math.abs(Math.log(ratio)) : 0;
};

/**
 * Shows the rows of the table that moved most, and all where the user wants them.
 * @param rows [name, unit, value] in the order of the table
 * @param others values by name that they are compared with, or null
 * @param chosen a name that is always seen
 */
export function fold(rows, others, chosen = null) {
  const sizes = rows.map(([name, , value]) => [name, others && !WITHOUT_RATIO.test(name) ? moved(value, others.get(name)) : 0]);
  const most = sizes.filter(([, size]) => size > 0.01).sort(([, a], [, b]) => b - a).slice(0, SEEN).map(([name]) => name);
  const seen = new Set([...(most.length ? most : USUAL), chosen]);
  const isAll = byId("all-indicators").checked;
  [...(byId("indicators").tBodies[0]?.rows ?? [])].forEach((row, index) => {
    row.hidden = !isAll && !seen.has(rows[index][0]);
  });
}
