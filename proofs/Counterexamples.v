(** Statements are disproved on one exact packing, its direction cosines, radii and load given as numbers.

    Values and slopes of both sides come from the theorems, as in proofs of true statements; only that
    they differ is computed. Off the lattice, where a wrong index leads, nothing is supposed of centres
    and forces, so that an example may have any there: here constants. *)

From ForceDiffusion Require Export Fractions.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Definition trial_lattice : lattice.
Proof. refine {| r := 3; n_x := 20 / 29; n_y := 21 / 29 |}; lra. Defined.

(** No two of some neighbouring ones are alike. *)
Definition trial_radii : radii := fun i j =>
  IZR ((31 * i * i + 7 * i * j + 53 * j * j * j + 11 * i * i * i + 29 * j + 5) mod 101 - 50).

(** ** Anything off the lattice *)

Definition is_bead (M i j : Z) : bool := (((i + j) mod 2 =? 0) && (0 <=? j) && (j <=? M))%bool%Z.

Definition on_lattice (M : Z) (X : centres) : centres :=
  fun i j e => if is_bead M i j then X i j e else zero.

Definition on_contacts (M : Z) (F : forces) : forces :=
  let known i j := (is_bead M i j || (j =? M))%bool%Z in
  Forces (fun i j e => if known i j then f_plus F i j e else 7)
         (fun i j e => if known i j then f_minus F i j e else 7).

Lemma on_bead M i j : bead M i j -> is_bead M i j = true.
Proof. unfold is_bead. intros H. site. Qed.

Lemma packing_on_lattice G M rho X : packing G M rho X -> packing G M rho (on_lattice M X).
Proof.
  intros P. unfold on_lattice.
  split; [intros i e H|intros i j H|intros i j H Hj; unfold touch..|intros i j H Hj];
    rewrite ?(on_bead M) by site; try rewrite !(on_bead M) by site.
  - apply (base_is_fixed _ _ _ _ P), H.
  - apply (continuous _ _ _ _ P), H.
  - apply (touches_left _ _ _ _ P i j H Hj).
  - apply (touches_right _ _ _ _ P i j H Hj).
  - apply (above_supports _ _ _ _ P i j H Hj).
Qed.

Lemma carries_on_contacts M X load F : carries M X load F -> carries M X load (on_contacts M F).
Proof.
  intros C. split; unfold balanced, on_contacts; cbn [f_plus f_minus].
  - intros i e. rewrite Z.eqb_refl, Bool.orb_true_r. apply (free_surface _ _ _ _ C).
  - intros i j H Hj. rewrite !on_bead by site. exact (balance _ _ _ _ C i j H Hj).
Qed.

(** The packing and its forces, at a height M and under a load; the packing goes on above it. *)
Notation higher M := (M + 2)%Z.
Definition trial (M : Z) : centres := on_lattice (higher M) (laid_packing trial_lattice trial_radii).
Definition trial_forces (M : Z) (load : Z -> Z -> vector) : forces :=
  on_contacts M (passed_down M (trial M) load).

Lemma trial_goes_on M : packing trial_lattice (higher M) trial_radii (trial M).
Proof. apply packing_on_lattice, laid_is_packing. Qed.

Lemma trial_is_packing M : packing trial_lattice M trial_radii (trial M).
Proof.
  pose proof (trial_goes_on M) as P. assert (B : forall i j, bead M i j -> bead (higher M) i j)
    by (intros; site).
  split; intros.
  - apply (base_is_fixed _ _ _ _ P). auto.
  - apply (continuous _ _ _ _ P). auto.
  - apply (touches_left _ _ _ _ P); auto.
  - apply (touches_right _ _ _ _ P); auto.
  - apply (above_supports _ _ _ _ P); auto.
Qed.

Lemma trial_carries M load : carries M (trial M) load (trial_forces M load).
Proof. apply carries_on_contacts, (passed_down_carries trial_lattice M trial_radii), trial_is_packing. Qed.

(** ** Values and slopes *)

Lemma off_lattice M i j e : is_bead (higher M) i j = false -> trial M i j e = zero.
Proof. intros H. unfold trial, on_lattice. rewrite H. reflexivity. Qed.

Lemma constant_expands f v : (forall e, f e = v) -> expands f v 0.
Proof.
  intros H. eapply expands_near; [apply (expands_const v)|]. apply near_always. intros e. symmetry. apply H.
Qed.

Lemma delta_x_off_lattice M i j e : is_bead (higher M) i j = false -> delta_x (trial M) i j e = zero.
Proof. intros H. unfold delta_x. rewrite !off_lattice by exact H. apply by_parts; components; ring. Qed.

Lemma delta_n_plus_off_lattice M i j e :
  is_bead (higher M) i j = false -> is_bead (higher M) (i + 1) (j + 1) = false ->
  delta_n_plus trial_lattice (trial M) i j e = minus zero (n_plus trial_lattice).
Proof.
  intros H K. unfold delta_n_plus, N_plus, direction. rewrite !off_lattice by assumption.
  apply by_parts; components; ring.
Qed.

Lemma delta_n_minus_off_lattice M i j e :
  is_bead (higher M) i j = false -> is_bead (higher M) (i - 1) (j + 1) = false ->
  delta_n_minus trial_lattice (trial M) i j e = minus zero (n_minus trial_lattice).
Proof.
  intros H K. unfold delta_n_minus, N_minus, direction. rewrite !off_lattice by assumption.
  apply by_parts; components; ring.
Qed.

Ltac constant of := eapply constant_expands; intros; rewrite of by reflexivity; reflexivity.

(** Of a force at a site: by the load's theorem, by nothing being there, or off the lattice. *)
Ltac of_trial_force M load i j :=
  let P := constr:(trial_is_packing M) in
  let C := constr:(trial_carries M load) in
  first
  [lazymatch load with
   | surface _ _ => apply (surface_force _ _ _ _ P _ i j ltac:(site) _ C)
   | bulk _ => apply (bulk_force _ _ _ _ P _ i j ltac:(site) _ C)
   | leaning_surface _ _ ?a ?b =>
       first [apply (leaning_f_plus _ _ _ _ P _ i j ltac:(site) a b (b / a) C); field
             |apply (leaning_f_minus _ _ _ _ P _ i j ltac:(site) a b (a / b) C); field]
   | single ?k ?l ?f =>
       first
       [apply (single_force _ M _ _ P _ k l f ltac:(site) ltac:(site) C j); site
       |apply (above_load _ M _ _ P _ k l f C j); site]
   end
  |apply (constant_expands _ 7); reflexivity].

Ltac of_trial :=
  lazymatch goal with
  | |- expands (f_plus (trial_forces ?M ?load) ?i ?j) _ _ => of_trial_force M load i j
  | |- expands (f_minus (trial_forces ?M ?load) ?i ?j) _ _ => of_trial_force M load i j
  | |- expands (fun e => f_plus (trial_forces ?M ?load) ?i ?j e) _ _ => of_trial_force M load i j
  | |- expands (fun e => f_minus (trial_forces ?M ?load) ?i ?j e) _ _ => of_trial_force M load i j
  | |- context [trial ?M] =>
      first [of_packing (trial_goes_on M)|constant delta_x_off_lattice|constant delta_n_plus_off_lattice
            |constant delta_n_minus_off_lattice]
  | |- _ => apply delta_r_expands
  end.

(** ** They differ *)

Lemma first_order_equal f g v d w c :
  first_order f g -> expands f v d -> expands g w c -> v = w /\ d = c.
Proof.
  intros (a & b & Hf & Hg) Ef Eg.
  destruct (expands_unique _ _ _ _ _ Hf Ef) as [<- <-]. exact (expands_unique _ _ _ _ _ Hg Eg).
Qed.

Lemma near_equal (f g : R -> R) v d w c :
  near (fun e => f e = g e) -> expands f v d -> expands g w c -> v = w /\ d = c.
Proof. intros N Ef Eg. exact (expands_unique _ _ _ _ _ (expands_near _ _ _ _ Ef N) Eg). Qed.

Lemma near_parts (u v : R -> vector) : near (fun e => u e = v e) ->
  near (fun e => x_of (u e) = x_of (v e)) /\ near (fun e => y_of (u e) = y_of (v e)).
Proof. intros N. split; (eapply near_then; [exact N|]); cbv beta; intros e ->; reflexivity. Qed.

Lemma trial_numbers : r trial_lattice = 3 /\ n_x trial_lattice = 20 / 29 /\ n_y trial_lattice = 21 / 29 /\
  phi trial_lattice = 41 / 841.
Proof. rewrite phi_is. cbn. lra. Qed.

Ltac as_numbers H :=
  cbv -[IZR Rplus Rmult Rminus Ropp Rinv Rdiv trial_lattice r n_x n_y phi] in H;
  destruct trial_numbers as (? & ? & ? & ?);
  repeat match goal with E : _ trial_lattice = _ |- _ => rewrite ?E in H; clear E end;
  rewrite <- ?Rminus_0_l in H.  (* [lra] knows no constant with a sign of its own *)

(** Sums between given bounds, term by term. *)
Ltac terms_of_sums H :=
  cbv [Sum sum_from Z.to_nat Z.sub Z.add Z.opp Z.of_nat Pos.of_succ_nat Pos.to_nat Pos.iter_op
    Pos.succ Pos.add Pos.pred_double Z.pos_sub Z.double Z.succ_double Z.pred_double Init.Nat.add] in H.

(** Both sides have values and slopes, which are not the same. *)
Ltac unlike equal H :=
  terms_of_sums H; unfold dot in H; cbv beta in H; components in H; eapply equal in H;
  [|solve [expand_with ltac:(fun _ => of_trial); let E := fresh in intros E; as_numbers E; lra]..];
  as_numbers H; lra.

(** Ordered positions. *)
Ltac positions H :=
  unfold position in H;
  repeat match type of H with
  | context [trial ?M ?i ?j 0] =>
      first [rewrite (ordered_position _ _ _ _ (trial_goes_on M) j) in H by site
            |rewrite (off_lattice M i j 0) in H by reflexivity]
  end.

(** What the statement supposes. *)
Ltac supposed :=
  lazymatch goal with
  | |- packing _ _ _ _ => exact (trial_is_packing _)
  | |- carries _ _ _ _ => exact (trial_carries _ _)
  | |- near (fun e => f_minus (trial_forces ?M (single ?k ?l ?f)) _ _ e = 0 /\ _) =>
      exact (proj2 (enters_alone _ M _ _ (trial_is_packing M) _ k l f ltac:(site) (trial_carries M _)
        1 ltac:(lra) ltac:(lia)))
  | |- near (fun e => f_plus (trial_forces ?M (single ?k ?l ?f)) _ _ e = 0 /\ _) =>
      exact (proj2 (enters_alone_mirrored _ M _ _ (trial_is_packing M) _ k l f 1 ltac:(site)
        (trial_carries M _) ltac:(lra) ltac:(lia)))
  | |- _ => first [site|lra|reflexivity]
  end.

Ltac disprove H :=
  repeat match type of H with ?A -> _ => specialize (H ltac:(supposed)) end;
  lazymatch type of H with
  | first_order_vector _ _ =>
      let K := fresh in destruct H as [H K]; first [unlike first_order_equal H|unlike first_order_equal K]
  | first_order _ _ => unlike first_order_equal H
  | near _ =>
      let K := fresh in
      apply near_parts in H; destruct H as [H K]; first [unlike near_equal H|unlike near_equal K]
  | @eq vector _ _ =>
      positions H;
      let K := fresh in
      pose proof (f_equal x_of H) as K; apply (f_equal y_of) in H;
      as_numbers H; as_numbers K; lra
  end.

(** ** Statistics *)

Lemma linearised_unique g f h : linearised g f -> linearised g h -> f = h.
Proof.
  intros F H. apply FunctionalExtensionality.functional_extensionality. intros rho.
  destruct (F rho) as (v & d & E & ->). destruct (H rho) as (w & c & D & ->).
  destruct (expands_unique _ _ _ _ _ E D) as [-> ->]. reflexivity.
Qed.

(** Two numbers for one quantity: of the layer that the example is in. *)
Ltac two_numbers :=
  repeat match goal with H : _ /\ _ |- _ => destruct H end;
  repeat match goal with H : ?A -> _ |- _ => specialize (H ltac:(lia)) end;
  match goal with T : ?x = _, H : ?x = _ |- _ => rewrite T in H; as_numbers H; lra end.

(** One statistic would be near two numbers. *)
Ltac near_two T H :=
  apply Rabs_def2' in H; apply Rabs_def2' in T;
  match type of T with
  | context [relative_variance ?L ?f] => generalize dependent (relative_variance L f); intros ? H T
  | context [variance ?L ?f] => generalize dependent (variance L f); intros ? H T
  end;
  as_numbers H; as_numbers T; lra.

(** Beside what is true of the same packing. *)
Ltac disprove_beside T H :=
  repeat match type of H with ?A -> _ => specialize (H ltac:(something)); specialize (T ltac:(something)) end;
  repeat lazymatch type of H with
  | exists f, _ => let f := fresh in let g := fresh in destruct H as [f H], T as [g T]
  | linearised _ _ /\ _ =>
      let K := fresh in let N := fresh in destruct H as [K H], T as [N T];
      rewrite (linearised_unique _ _ _ K N) in H; clear K N
  end;
  lazymatch type of H with Rabs _ <= _ => near_two T H | _ => two_numbers end.
