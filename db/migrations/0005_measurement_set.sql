-- Sets of measurements that users keep. A version does not change: what is new stands beside it, so
-- that a calibration can be traced to the numbers it was given.
CREATE TABLE measurement_set (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  version INTEGER NOT NULL,
  material TEXT NOT NULL,
  created_at INTEGER NOT NULL,
  measurements TEXT NOT NULL,
  UNIQUE (name, version)
) STRICT;

CREATE TRIGGER measurement_set_final BEFORE UPDATE ON measurement_set
BEGIN
  SELECT RAISE(ABORT, 'a version of a measurement set does not change');
END;

-- What a calibration is of, and which set it took its measurements from.
CREATE TABLE calibration_source (
  calibration_id INTEGER PRIMARY KEY REFERENCES calibration (id),
  material TEXT,
  measurement_set_id INTEGER REFERENCES measurement_set (id)
) STRICT;

CREATE INDEX calibration_source_by_material ON calibration_source (material, calibration_id);
