# From `gather --series --columns time_ps,moment_nN_nm,twist_eV,Q` of a sweep, for each run: its largest twist energy and
# the part of it that is gone at 174 ps and at the end; the largest Q while the load grows, and Q at the end.
BEGIN {
  FS = ","
  print "point,largest_twist_keV,at_ps,released_at_174_ps_percent,released_at_end_percent,Q_while_loading,Q_at_end"
}
function written() {
  if (point != "")
    printf "%s,%.1f,%.0f,%.0f,%.0f,%.0f,%.0f\n", point, largest / 1e3, at, 100 * (1 - then / largest), \
      100 * (1 - last / largest), loading, q
}
NR > 1 {
  moment = $(NF - 2)
  if ($1 != point) {
    written()
    point = $1; largest = 0; nearest = 1e9; loading = 0; before = -1
  }
  time = $(NF - 3); last = $(NF - 1); q = $NF
  if (last > largest) { largest = last; at = time }
  distance = time > 174 ? time - 174 : 174 - time
  if (distance < nearest) { nearest = distance; then = last }
  if (moment > before + 1e-6 && q > loading) loading = q
  before = moment
}
END { written() }
