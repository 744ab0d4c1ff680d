(** What the generated statements are proved with: one tactic an equation.

    A tactic finds value and slope of both sides from the theorems on packings and forces, and
    compares them. Nothing here is trusted: a tactic that goes wrong proves nothing. *)

From Coq Require Export ZArith Reals Lia Lra.
From ForceDiffusion Require Export Roots Model Sums FirstOrder Lattice Geometry Mirror Forces Existence Random Weights Exact
  Variances Cone.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

(** What divisors are made of is positive. *)
Ltac positive_things G :=
  pose proof (r_pos G); pose proof (n_x_pos G); pose proof (n_y_pos G);
  pose proof (divisor_positive G); pose proof (phi_above G); pose proof (phi_below G).
Ltac nonzero :=
  cbv beta; repeat split;
  first [assumption|lra|repeat first [assumption|apply Rmult_integral_contrapositive_currified|apply pow_nonzero]; lra].

(** Equal by arithmetic; if need be with φ = n_y² − n_x² and n_x² + n_y² = 1. *)
Ltac arithmetic G :=
  first
  [field; nonzero
  |field_simplify_eq; [rewrite ?phi_is; ring [(n_y_squared G)]|nonzero..]].

(** The values and slopes of what a packing consists of. *)
Ltac of_packing P :=
  lazymatch goal with
  | |- expands (fun e => delta_r _ _ _ e) _ _ => apply delta_r_expands
  | |- expands (delta_r _ _ _) _ _ => apply delta_r_expands
  | |- expands (fun e => _ (delta_x _ _ _ e)) _ _ => apply (delta_x_expands _ _ _ _ P); site
  | |- expands (fun e => _ (delta_n_plus _ _ _ _ e)) _ _ => apply (delta_n_plus_expands _ _ _ _ P); site
  | |- expands (fun e => _ (delta_n_minus _ _ _ _ e)) _ _ => apply (delta_n_minus_expands _ _ _ _ P); site
  | |- ?g => idtac "no rule for" g; fail
  end.

Ltac both_sides known :=
  unfold dot; components; eapply first_order_by; [expand_with known|expand_with known|..]; cbv beta.

Lemma by_parts u v : x_of u = x_of v -> y_of u = y_of v -> u = v.
Proof. destruct u, v. cbn. intros -> ->. reflexivity. Qed.

Ltac prove_1 :=
  intros G rho M i j X P H Hj;
  unfold position; rewrite (ordered_position G M rho X P j) by site;
  apply by_parts; components; arithmetic G.

Ltac prove_2 :=
  intros G rho M i j X P H Hj; positive_things G;
  rewrite ?(along_plus_step rho i j), ?(along_minus_step rho i j) by lia;
  split; both_sides ltac:(fun _ => of_packing P);
  try nonzero;
  rewrite ?(along_plus_step rho i j), ?(along_minus_step rho i j) by lia;
  arithmetic G.

Ltac prove_3 :=
  intros G rho M i j X P H Hj; positive_things G;
  split; both_sides ltac:(fun _ => of_packing P);
  try nonzero; elementary_sums; try solve [arithmetic G]; unfold along_minus, along_plus, mirrored;
  replace (j =? 0)%Z with false by lia; normal_form; arithmetic G.

(** Eqs. 4 and 5, by what is known of a tilt in the radii. *)
Ltac prove_tilt tilt tilt_is :=
  intros G rho M i j X P H Hj; positive_things G;
  split; both_sides ltac:(fun _ => of_packing P);
  try nonzero; elementary_sums; try solve [arithmetic G];
  (replace (tilt G rho i j) with (2 * r G * tilt G rho i j / (2 * r G)) by (arithmetic G));
  rewrite tilt_is by lia; normal_form; arithmetic G.
Ltac prove_4 := prove_tilt tilt_plus tilt_plus_is.
Ltac prove_5 := prove_tilt tilt_minus tilt_minus_is.

(** ** Forces *)

Ltac of_forces P known :=
  lazymatch goal with
  | |- expands (fun e => f_plus _ ?i ?j e) _ _ => known i j
  | |- expands (fun e => f_minus _ ?i ?j e) _ _ => known i j
  | |- expands (f_plus _ ?i ?j) _ _ => known i j
  | |- expands (f_minus _ ?i ?j) _ _ => known i j
  | |- _ => of_packing P
  end.

(** On a leg of the cone, inside of it, or outside: as the hypotheses on the indices say. *)
Ltac where_it_is :=
  unfold ordered_minus, ordered_plus, response_minus, response_plus, turn_plus;
  cbv zeta; decide_conditions; rewrite ?tilt_plus_mirrored, ?tilt_minus_mirrored.

Ltac of_single P L C i j := apply (single_force _ _ _ _ P _ _ _ _ L ltac:(site) C j); site.

Ltac prove_6 :=
  intros;
  match goal with P : packing ?G ?M ?rho ?X, C : carries _ _ (single ?k ?l ?f) ?F |- _ =>
    assert (L : bead M k l) by site;
    apply (near_then _ _ (loaded_bead G M rho X P F _ k l C L ltac:(site)
      (fun i j Hj => no_load k l f i j ltac:(lia))))
  end;
  intros e E; pose proof (f_equal x_of E) as Ex; pose proof (f_equal y_of E) as Ey;
  unfold delta_n_plus, delta_n_minus; apply by_parts; components; components in Ex; components in Ey;
  lra.

(** Below a load on one bead: on a leg of its cone, inside of it (Eqs. 7, 9, 10), or outside. *)
Ltac below_load :=
  intros;
  match goal with P : packing ?G ?M _ _, C : carries _ _ (single ?k ?l ?f) _ |- _ =>
    positive_things G; assert (L : bead M k l) by site;
    assert (0 < f / (2 * n_y G)) by (apply Rdiv_lt_0_compat; lra);
    both_sides ltac:(fun _ => of_forces P ltac:(of_single P L C));
    where_it_is; try nonzero; same_values; arithmetic G
  end.
Ltac prove_7 := below_load.
Ltac prove_9 := below_load.
Ltac prove_10 := below_load.

Ltac of_passage P F i j :=
  match goal with C : carries _ _ _ F |- _ =>
    first [apply (propagates _ _ _ _ P F _ i j C)|apply (propagates_mirrored _ _ _ _ P F _ i j C)];
    first [assumption|site]
  end.

Ltac prove_8 :=
  intros G rho M i j load X F P; intros; positive_things G; unfold dot; components;
  eapply first_order_by;
  [of_passage P F i j|expand_with ltac:(fun _ => of_packing P)|..]; cbv beta;
  try nonzero; arithmetic G.

Ltac of_surface P C i j := apply (surface_force _ _ _ _ P _ i j ltac:(site) _ C).

Ltac prove_11 :=
  intros G rho M i j f_load X F P; intros; positive_things G;
  match goal with C : carries _ _ _ _ |- _ =>
    both_sides ltac:(fun _ => of_forces P ltac:(of_surface P C))
  end;
  try nonzero; rewrite ?change_minus_is; unfold change_plus, turned; normal_form;
  arithmetic G.

(** ** Variances *)

Lemma height_positive M i j : contact M i j -> 0 < IZR M.
Proof. intros H. apply (IZR_lt 0). site. Qed.

(** A bound on |v − q| with q = p, b = c by arithmetic is one on |v − p|. *)
Lemma bound_is v p b q c : Rabs (v - q) <= c -> p = q -> c = b -> Rabs (v - p) <= b.
Proof. intros H -> <-. exact H. Qed.

Ltac by_arithmetic G := unfold unit_of; rewrite ?minus_IZR; arithmetic G.

(** The form to first order in one contact under a load of whole layers: what is known of its variance. *)
Ltac with_variance theorem next :=
  let G := fresh "G" in
  intros G sigma S M i j W f_load L Xs Fs P; intros; positive_things G;
  match goal with
  | H : contact M i j, HW : (Z.abs i + M + 2 <= W)%Z, Hf : 0 < f_load,
    C : forall rho, carries M (Xs rho) _ (Fs rho) |- _ =>
      pose proof (height_positive M i j H);
      destruct (theorem G M W sigma S L Xs Fs P i j H HW f_load Hf C) as (A & E & V & B);
      eexists; split; [exact A|next G]
  end.
Ltac near_printed G :=
  eapply bound_is; [eassumption|by_arithmetic G|by_arithmetic G].
Ltac prove_13 := with_variance surface_variance near_printed.
Ltac prove_14 := with_variance bulk_variance near_printed.

(** Mean and variance in every layer, case by case. *)
Ltac site_of_case :=
  try match goal with H : contact _ _ ?j |- _ => is_var j; assert (j = 0)%Z by lia end;
  repeat match goal with E : ?x = _ :> Z |- _ => is_var x; subst x end; unfold contact in *.
Ltac every_layer G :=
  match goal with
  | E : expect _ _ = _, V : relative_variance _ _ = _, H : contact ?M ?i ?j |- _ =>
      split; [rewrite E; by_arithmetic G|];
      assert (0 < IZR M - IZR j) by (rewrite <- minus_IZR; apply (IZR_lt 0); site);
      rewrite V; unfold surface_squares, bulk_squares, below_squares, plain, beside, twice;
      clear E V; repeat split; intros; repeat match goal with C : _ /\ _ |- _ => destruct C end; site_of_case; decide_on; by_arithmetic G
  end.
Ltac prove_13_exact := with_variance surface_variance every_layer.
Ltac prove_14_exact := with_variance bulk_variance every_layer.

Lemma braces_are j M m : (0 <= j < M)%Z -> (1 <= m <= M)%Z ->
  braces (IZR M - IZR j) (IZR M - IZR m) m j = braces_at j M m.
Proof.
  intros H Hm. unfold braces, braces_at, on. replace (m <=? M)%Z with true by lia.
  rewrite <- !minus_IZR. destruct (m <=? j)%Z eqn:E; f_equal; lia.
Qed.

Ltac prove_12 :=
  intros G sigma S M i j W f_load L Xs Fs P; intros; positive_things G;
  match goal with
  | H : contact M i j, HW : (Z.abs i + M + 2 <= W)%Z, Hf : 0 < f_load,
    C : forall rho, carries M (Xs rho) (surface M f_load) (Fs rho) |- _ =>
      pose proof (height_positive M i j H);
      exists (fun rho => change_plus G rho M i j), (by_braces G M i j);
      split; [|split; [|eapply Rle_trans;
        [exact (braces_miss G M W sigma S L Xs Fs P i j H HW)|apply Req_le; by_arithmetic G]]];
      intros rho; pose proof (P rho) as Pr; pose proof (C rho) as Cr;
      cbv zeta; unfold second_difference;
      [exists 0, (change_plus G rho M i j)|exists 0, (by_braces G M i j rho)]; (split; [|ring]);
      (eapply expands_to;
        [expand_with ltac:(fun _ => of_forces Pr ltac:(of_surface Pr Cr))|..]);
      cbv beta; try nonzero; no_zero_sums; try solve [arithmetic G]
  end;
  unfold by_braces;
  match goal with
  | |- context [Sum ?a ?b (fun m => braces_at ?j ?M m * @?f m)] =>
      match goal with
      | |- context [Sum ?c ?d ?g] =>
          lazymatch g with context [braces] =>
            replace (Sum c d g) with (Sum a b (fun m => braces_at j M m * f m))
              by (apply Sum_eq; [lia|lia|intros; cbv beta; rewrite braces_are by site;
                                 sites_in_normal_form; ring])
          end
      end
  end; arithmetic G.

Lemma root_constant k : 0 < k -> constant (fun x => sqrt k / (1 - x * x)).
Proof. intros H x Hx. apply constant_positive; assumption. Qed.

(** Eq. 15 under one load, with the constant √k/(1 − φ²). *)
Lemma averages_are (G : lattice) (M : Z) (sigma k b s p : R) :
  0 < sigma -> (1 <= M)%Z -> 0 < k -> b = 10 * k \/ b = 4 * k ->
  Rabs (s - unit_of G sigma * (k * (IZR M * IZR M * IZR M))) <= b * (IZR M * IZR M) * unit_of G sigma ->
  p = root 2 (IZR M) ^ 3 * sigma / r G ->
  Rabs (sqrt s - sqrt k / (1 - phi G * phi G) * p) <= 10 / IZR M * (sqrt k / (1 - phi G * phi G) * p).
Proof.
  intros Hs HM Hk Hb H ->. pose proof (r_pos G). pose proof (divisor_positive G).
  assert (One : 1 <= IZR M) by (apply (IZR_le 1); exact HM).
  eapply Rle_trans; [apply (root_of_average G M sigma k b s); assumption|].
  apply Rmult_le_compat_r.
  - apply Rlt_le, Rmult_lt_0_compat; apply Rdiv_lt_0_compat; try lra; [apply sqrt_lt_R0; lra|].
    apply Rmult_lt_0_compat; [apply pow_lt, root_is; [lia|lra]|lra].
  - apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra|].
    destruct Hb as [-> | ->]; apply (Rmult_le_reg_r k); try lra; unfold Rdiv;
      rewrite Rmult_assoc, Rinv_l; lra.
Qed.

Ltac prove_average k average :=
  intros G sigma S M W across f_load L Xs Fs P; intros; positive_things G;
  match goal with
  | A : forall j, (0 <= j < M)%Z -> contact M (across j) j /\ (Z.abs (across j) + M + 2 <= W)%Z,
    HM : (1 <= M)%Z, Hf : 0 < f_load,
    C : forall rho, carries M (Xs rho) _ (Fs rho) |- _ =>
      let Lin := fresh in let B := fresh in
      destruct (average G M W sigma S L Xs Fs P across A HM f_load Hf C) as [Lin B];
      eexists; split; [exact Lin|];
      unfold root_mean_square; cbv beta;
      eapply (averages_are G M sigma k); [assumption|assumption|lra|
        |eapply bound_is; [exact B|field|reflexivity]|arithmetic G]; lra
  end.

Lemma power_constant k : 0 < k -> constant (fun x => / root 3 (sqrt k / (1 - x * x)) ^ 2).
Proof.
  intros H x Hx. apply Rinv_0_lt_compat, pow_lt, root_is; [lia|]. apply constant_positive; assumption.
Qed.

Lemma iff_as (a b m n v : R) : (a = v <-> m = n) -> b = a -> forall k, k = n -> (b = v <-> m = k).
Proof. intros H -> k ->. exact H. Qed.

Ltac prove_critical k :=
  let G := fresh "G" in let sigma := fresh "sigma" in let m := fresh "m" in
  intros G sigma m S Hm; positive_things G;
  let c := constr:(sqrt k / (1 - phi G * phi G)) in
  assert (Hc : 0 < c) by (apply Rdiv_lt_0_compat; [apply sqrt_lt_R0|]; lra);
  assert (Hs : 0 < sigma / r G) by (apply Rdiv_lt_0_compat; lra);
  cbv beta; eapply iff_as; [exact (critical_height c (sigma / r G) m Hc Hs Hm)|arithmetic G|unfold Rdiv; ring].

Ltac prove_15 :=
  split;
  [exists (fun x => sqrt 1 / (1 - x * x)), (fun x => / root 3 (sqrt 1 / (1 - x * x)) ^ 2);
   split; [apply root_constant; lra|split; [apply power_constant; lra|split;
     [prove_average 1 surface_average|prove_critical 1]]]
  |exists (fun x => sqrt (1 / 5) / (1 - x * x)), (fun x => / root 3 (sqrt (1 / 5) / (1 - x * x)) ^ 2);
   split; [apply root_constant; lra|split; [apply power_constant; lra|split;
     [prove_average (1 / 5) bulk_average|prove_critical (1 / 5)]]]].

Ltac prove_16 :=
  intros G sigma S M k l i j p q W f_load L Xs Fs P; intros; positive_things G;
  subst k l;
  match goal with
  | B : bead M i j, HW : (Z.abs i + M + 2 <= W)%Z, Hf : 0 < f_load,
    C : forall rho, carries M (Xs rho) (single _ _ f_load) (Fs rho) |- _ =>
      let A := fresh in let D := fresh in let f := fresh in
      destruct (response_variance G M W i j p q B ltac:(site) ltac:(site) ltac:(site) HW sigma L
        Xs Fs f_load S Hf P C) as (f & A & D);
      exists f
  end;
  split; [assumption|eapply bound_is; [eassumption|by_arithmetic G|by_arithmetic G]].
