-- Raised where a webhook is replaced: what a delivery that began before came to is not its any more.
ALTER TABLE webhook ADD COLUMN revision INTEGER NOT NULL DEFAULT 0;
